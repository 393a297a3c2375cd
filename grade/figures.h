// What a run of `gnomon compare` left behind: figures of its result.json and its pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/comparison.h"
#include "grade/rubric.h"
#include "raster/function_call.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

/// Where a run's --aov files (values*.exr) lie: beside its folder.
std::string values_folder(const std::string& folder);

/// A finished run's folder, read.
struct RunResult {
  std::string folder;
  std::vector<double> figures;  ///< as measures() lists them: the worst of the lights
  double shading_ms = 0.0;      ///< the shortest of the shading passes, summed over the lights
  /// Compared pixels drawn halfway between right and wrong, over all lights; figures count them in wrong and
  /// mean_error alone before add_ties().
  std::uint64_t ties = 0;
  std::vector<raster::Answer> answers{};  ///< of a function, to all its questions; else empty
};

/// Where the answers of a function are written.
std::string answers_file(const std::string& folder);
/// Reads the answers of a function's calls.
Expected<RunResult> read_called(const Run& run, const std::string& folder);

/// Errors: the folder holds no result of this version.
Expected<RunResult> read_run_result(const std::string& folder);

/// Counts the ties in false_shadow and missed_shadow too, each by half, so that the two are what is wrong. Which of
/// them a tie belongs to stands in the values alone (values_folder).
Expected<void> add_ties(RunResult& result);

/// The constant bias with which a test of the program's own would draw most nearly the same, world units
/// (values_folder).
Expected<double> nearest_bias(const RunResult& result);

/// The figure of that name, as measures() lists them.
double figure_of(const RunResult& result, std::string_view measure);

/// Compared pixels whose drawn visibility differs between two runs of the same scene by more than one half of an
/// 8-bit step, over all lights (values_folder).
Expected<std::uint64_t> count_different(const RunResult& a, const RunResult& b);

/// What one drawing has in common with another beside the right one, in compared pixels over all lights.
struct Agreement {
  std::uint64_t compared = 0;
  std::uint64_t wrong = 0;        ///< that the first draws otherwise than the right one
  std::uint64_t either = 0;       ///< that the first or the second does
  std::uint64_t unlike = 0;       ///< that the two draw otherwise
  std::uint64_t explained = 0;    ///< that the first draws wrong, and the second alike
  std::uint64_t other_wrong = 0;  ///< that the second draws otherwise than the right one
  /// The two draw all but a twentieth of what either draws wrong alike.
  bool is_like() const { return 20 * unlike <= either; }
  double alike() const { return 1.0 - static_cast<double>(unlike) / static_cast<double>(compared); }
};

/// The visibility of every compared pixel of a run, over all lights; of a function the answers to the run's cases, in such
/// units that what is right stays within half an 8-bit step.
struct DrawnValues {
  std::vector<float> visibility;
  bool is_uniform = false;  ///< all alike, to half an 8-bit step; of a function all answers to whatever cases
  /// Which pixels these are, of each light in turn: the name of its file, and their indices.
  std::vector<std::pair<std::string, std::vector<std::uint32_t>>> compared{};
};
/// Errors as count_different().
Expected<DrawnValues> read_values(const Run& run, const RunResult& result);
/// Reads a folder that CheckRuns::draw_each() left: what is drawn at the pixels that are compared in `right`. Empty where it holds
/// nothing.
Expected<DrawnValues> read_drawn(const std::string& folder, const DrawnValues& right);
/// Reads such a folder of a function's calls; nothing where it holds nothing.
Expected<std::optional<RunResult>> read_each_called(const Run& run, const std::string& folder);

/// All three are of the same run.
Agreement compare_drawings(const DrawnValues& drawn, const DrawnValues& other, const DrawnValues& right);

/// raster.png, raytrace.png and the labels' pictures that there are, by file name.
Expected<std::vector<std::string>> pictures_of(const RunResult& result);
/// Returns the labels of the pixels that are wrong, in any light, the most frequent first.
std::vector<compare::Label> labels_of(const RunResult& result);

}  // namespace gnomon::grade
