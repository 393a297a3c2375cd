// What a teacher asks of a shader: checks with points, read from a rubric file (rubric.schema.json).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon::compare {
struct Figure;
}

namespace gnomon::grade {

/// What a check looks at: one comparison, that is a scene and options of `gnomon compare`, or the calls of a function.
struct Run {
  std::string scene;  ///< a built-in scene's name, or a path that the caller can open
  std::string named;  ///< the scene as the rubric names it, from its own folder
  std::vector<std::pair<std::string, std::string>> options;  ///< {"map-size", "512"}, in the rubric's order
  std::string function;  ///< "ray_box" (functions/functions.h); empty: a comparison
  std::string cases;     ///< of the function: a group's name
  bool operator==(const Run&) const = default;
};

enum class CheckKind : std::uint8_t {
  draws,    ///< compiles, ends in time, and gives a number in [0, 1] at every pixel
  at_most,  ///< a figure of the result stays within a limit
  equals,   ///< draws what the program's own shader draws, but for some pixels
  time,     ///< takes at most so many times as long as the program's own shader
  answers   ///< a function gives the right answers to a group of cases
};

/// A figure of result.json, by the name that a rubric gives it.
struct Measure {
  std::string_view name;
  enum class Unit : std::uint8_t { share, texels } unit;  ///< of the pixels compared; texels of the map
  std::string_view words;                                 ///< "false shadows"
  const compare::Figure* figure = nullptr;                ///< null: a label
  bool may_be_unknown = false;  ///< a label that pixels labelled custom_shader may hide
};
/// wrong, false_shadow, missed_shadow, mean_error, detachment, edge, and every label.
const std::vector<Measure>& measures();

struct Check {
  std::string name;     ///< for people
  double points = 0.0;  ///< > 0; all of them or none
  CheckKind kind = CheckKind::draws;
  Measure measure{};               ///< of at_most
  double limit = 0.0;              ///< at_most: in the measure's unit; equals: pixels; time: a multiple
  std::vector<std::size_t> needs;  ///< earlier checks, without whose points this one gives none
  std::string hint;                ///< shown beside points that were lost; may be empty
  std::vector<Run> runs;           ///< at least one; every one has to pass
};

struct Limits {
  double seconds = 20.0;      ///< of processor time for each run, that of all its threads together, > 0
  double memory_mb = 4096.0;  ///< of address space for each run, >= 1024
  double idle_seconds =
      120.0;  ///< of wall time without any processor time: then a run is given up. No rubric's to set
};

/// A shader that the exercise gives: it stands in each student's folder as it is here.
struct GivenFile {
  std::string name, text;  ///< "technique/hard.glsl"
};

struct Rubric {
  std::string title, text;
  std::string technique;  ///< whose shader is handed in: "hard"; empty: functions are (of function/)
  std::vector<std::string>
      hand_in;  ///< the program's shaders that may be replaced, or files that a given one includes
  std::vector<GivenFile> given;  ///< none: what is handed in may use all that the program's own shaders have
  std::vector<std::string>
      begun;                    ///< what students begin with: texts of the files of hand_in beside the rubric
  std::string language = "en";  ///< of the rubric's own words: a BCP 47 tag
  Limits limits;
  std::vector<Check> checks;  ///< at least one
  double points() const;      ///< of all checks
};

/// Scenes that are files are taken relative to the rubric's folder. Errors (bad input) name the field.
Expected<Rubric> read_rubric(const std::string& path);

/// "tilted.json --map-size 512 --bias 0.01": the run as words of a command line in the rubric's folder.
std::string run_text(const Run& run);

}  // namespace gnomon::grade
