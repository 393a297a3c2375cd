// gnomon diff: what became better or worse between two results of the same scene, seen from the same place.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison.h"
#include "compare/result/figures.h"
#include "compare/result/threshold.h"
#include "scene/base/expected.h"
#include "scene/image.h"

namespace gnomon::studies {

/// untold: they differ, but not by more than chance allows (spread.h).
enum class Trend : std::uint8_t { same, untold, better, worse, mixed };
std::string_view trend_name(Trend trend);
/// Of several: worse and better are mixed.
Trend together(Trend a, Trend b);

/// `spread`: by how much the figure may differ by chance; infinite where that is not known.
struct FigureChange {
  const compare::Figure* figure = nullptr;
  double before = 0.0, after = 0.0, spread = 0.0;
  Trend trend = Trend::same;
  bool in_texels_now = false;  ///< `before` is converted from texels of another width

  /// How much worse it is, in the figure's unit; negative: better.
  double worse_by() const;
};

/// Milliseconds with their intervals; between machines, and where the intervals meet, nothing is told.
struct TimeChange {
  std::string key;                          ///< in times_ms.shadows of a light: "light_moves_map"
  std::string words;                        ///< "light or camera moves, by the map"
  std::array<double, 3> before{}, after{};  ///< median, low, high
  Trend trend = Trend::same;
};

/// Pixels that are wrong by one label.
struct LabelChange {
  compare::Label label = compare::Label::right;
  std::uint64_t before = 0, after = 0;  ///< by the results' own counts
  std::uint64_t fixed = 0, newly_wrong = 0,
                still = 0;  ///< by the pictures; `still` with the label it has now
};

/// What became of each pixel. Both pictures are the diff's own, in colours of its own and of the labels.
struct PixelChange {
  std::uint64_t fixed = 0, newly_wrong = 0, still = 0;
  std::uint64_t uncounted = 0;  ///< wrong in one result, and not compared in the other
  Rgb8Image change, new_labels;
};
inline constexpr glm::u8vec3 newly_wrong_colour{0xd5, 0x5e, 0x00}, fixed_colour{0x00, 0x9e, 0x73},
    still_wrong_colour{0x00, 0x72, 0xb2};

struct LightDiff {
  std::string name;
  std::vector<std::string> chances;  ///< spread.h
  std::vector<FigureChange> figures;
  std::vector<TimeChange> times;
  std::vector<LabelChange> labels;  ///< those that either result has
  std::optional<PixelChange> pixels;
  std::string no_pixels;  ///< why there are none
  Trend trend = Trend::same;
  std::string too_much;  ///< what is worse than the limit; empty: nothing
};

/// A setting of the map that differs, by its key in result.json.
struct ChangedSetting {
  std::string key, before, after;
};

struct Diff {
  std::string scene;
  std::array<std::string, 2> paths, commands, versions;  ///< before, after
  std::optional<compare::Threshold> fail_worse;
  std::vector<std::string> notes;
  std::vector<ChangedSetting> changed;
  std::vector<LightDiff> lights;
  Trend trend = Trend::same;
  bool too_much() const;
};

struct DiffOptions {
  const compare::Figure* measure = &compare::wrong_and_mean();  ///< whose change is the verdict
  std::optional<compare::Threshold> fail_worse{};
  bool changed_scene = false;  ///< its file may have changed in between
  std::string_view if_changed =
      "--changed-scene compares them all the same";  ///< what helps where it may not
};

/// `before`, `after`: result.json, or the folder that it is in. ErrorKind::bad_input: one cannot be read, or they cannot
/// be compared; the reason says why.
Expected<Diff> diff_results(const std::string& before, const std::string& after, const DiffOptions& options);

// How a diff is written.

/// Schema "gnomon/diff/1" (docs/design.md).
std::string diff_json(const Diff& diff);
/// For the terminal.
std::string diff_text(const Diff& diff);
/// DIR/report.html and DIR/diff.json, which appear together; `json`: a file that gets the same.
Expected<void> write_diff(const Diff& diff, const std::string& folder, const std::string& json);

}  // namespace gnomon::studies
