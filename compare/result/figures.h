// Every number that a comparison says of one light, one row each. A row has the key in result.json, unit and words, which
// way is better, how it is printed, and what it is of several lights together. The blocks of result.json and their part of
// the schema are made from these rows, and with them the columns of CSV files and of the pages. So is what sweeps read back
// from their lines and show. A new figure is a field of LightFigures and a row in figure_rows.cpp.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace gnomon::compare {

struct LightFigures;

enum class FigureForm : std::uint8_t { count, percent, number };
enum class Better : std::uint8_t { neither, less, more };
/// What a figure takes that not every comparison makes.
enum class FigureNeeds : std::uint8_t { nothing, edges, perception, film };

/// Where a figure stands. Counts are below 2^53, so that a double holds them.
struct FigurePlace {
  double (*get)(const LightFigures&);            ///< NaN where it was not made
  void (*set)(LightFigures&, double) = nullptr;  ///< null: it follows from other figures
  FigureForm form = FigureForm::number;
  bool optional = false;  ///< not every light has the block
  bool nullable = false;  ///< null in result.json where it was not made
  double least = 0.0,
         most =
             std::numeric_limits<double>::infinity();  ///< of a share: 1 at most, and with a sign -1 at least
};

/// What a figure is of several lights together.
struct Pooling {
  enum class Kind : std::uint8_t { none, sum, mean, root_mean_square, same, derived } kind = Kind::none;
  /// Returns the weight of a light for means, and for `derived` what the other pooled figures make.
  double (*function)(const LightFigures&) = nullptr;
};

/// What a threshold calls a figure, and how it is said, "{}" being its value.
struct MeasureWords {
  std::string_view name{};     ///< "flip"; "" where no threshold is held against it
  std::string_view said{};     ///< "mean FLIP {}"
  std::string_view limit{};    ///< "a mean FLIP of at most {}"
  std::string_view level{};    ///< "a mean FLIP of {}"
  std::string_view example{};  ///< a limit as people write it: "0.05"
  std::string_view most{};     ///< the largest limit, as people write it; of a share ""
  bool by_halves = false;      ///< it asks on which side of one half a visibility lies, not how much it is
};

/// What a rubric calls a figure, and what it is about.
struct MarkWords {
  std::string_view name{}, words{};
};

struct Figure {
  std::string_view key;        ///< in a light of result.json: "error.wrong_fraction"
  std::string_view unit;       ///< "pixels", "texels"; "share": of one
  std::string_view describes;  ///< in result_schema()
  FigurePlace place;
  Better better = Better::neither;
  Pooling pooling{};
  std::string_view words{};  ///< for people; "" where those of the key do
  enum class Table : std::uint8_t { none, sweep } table = Table::none;  ///< has a column of it
  FigureNeeds needs = FigureNeeds::nothing;
  MeasureWords measure{};
  MarkWords mark{};
  std::string_view
      in_summary{};  ///< what stands before it in the terminal's line of errors; "" where it is not there

  FigureForm form() const { return place.form; }
  double of(const LightFigures& light) const { return place.get(light); }
  /// The part of the key before its last point: "error".
  std::string_view block() const { return key.substr(0, key.rfind('.')); }
  /// The part of the key after its last point: "wrong_fraction".
  std::string_view name() const { return key.substr(key.rfind('.') + 1); }
};

/// All of them; those of a block in the order of result.json.
std::span<const Figure> figures();

/// The figures of all lights together.
LightFigures pool_lights(std::span<const LightFigures> lights);

/// "count", "percent", "number"
std::string_view form_name(FigureForm form);
/// "edge error"
std::string figure_name(const Figure& figure);
/// What a measure is of, in running text: "wrong pixels", "mean error", "FLIP".
std::string measure_words(const Figure& measure);
/// A table's head: "edge error, texels".
std::string figure_head(const Figure& figure);
/// The value as settings are ranked by it: what is not known comes last.
inline double ranked(double value) {
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}
/// In running text, with texels as its unit: "4.1 %", "1.6 texels".
std::string figure_text(const Figure& figure, double value);

}  // namespace gnomon::compare
