// What the writers of result.json, CSV, summary and report share: the records of one light.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/comparison.h"
#include "compare/result/judged.h"
#include "compare/result/option_names.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::compare {

inline const raster::LightRecord& drawn_record(const Comparison& c, const LightComparison& light) {
  return c.raster.lights[light.record];
}
inline const raytrace::LightTruth& true_record(const Comparison& c, const LightComparison& light) {
  return c.raytraced.lights[light.record];
}
inline const Light& light_of(const Comparison& c, const LightComparison& light) {
  return c.world->scene->lights[light.light];
}
/// Whether stored depths are compared with receivers: not by izb and hybrid, nor where no map is known.
inline bool compares_depths(const Comparison& c) {
  return c.raster.has_known_map() && compares_depths(c.raster.options.map.technique);
}
/// Whether a depth is compared with a bias: a shader of the user's own may read none.
inline bool draws_bias(const Comparison& c) {
  const auto& custom = c.raster.custom_shader;
  return compares_depths(c) && (!custom || custom->reads_bias);
}
/// Without the map there are two steps: light size, and all the rest, unless rays were traced. Casters of another renderer's
/// map are one more.
inline std::size_t known_steps(const Comparison& c) {
  if (!c.raster.has_known_map() && !(c.judged && c.judged->traces)) return 2;
  return c.judged && c.judged->has_map ? cause_count + 1 : cause_count;
}
inline std::string_view step_name(const Comparison& c, Cause cause) {
  return !c.raster.has_known_map() && cause == Cause::sampling
             ? "unexplained"
             : cause_name(cause, ladder_of(c.raster.options.map.technique));
}
/// "hard"; "unknown" where another renderer's map is not known.
inline std::string_view drawn_technique(const Comparison& c) {
  return c.raster.has_known_map() ? technique_name(c.raster.options.map.technique) : "unknown";
}

/// A light's name as a part of a file name, unique among the lights compared; `light` is one of them.
std::string light_file_part(const Comparison& comparison, const LightComparison& light);
/// The same by the names of all lights compared; `number`: that of this light in the scene.
std::string light_file_part(std::span<const std::string> names, std::size_t which, std::size_t number);
/// Where one light's channels go: `path` itself, or with "-NAME" before the extension when there are several
/// lights.
std::string aov_path(const Comparison& comparison, const LightComparison& light, const std::string& path);

/// The text of result.json with these times in place of the comparison's own (the writer knows how long
/// writing took).
std::string result_json(const Comparison& comparison, double report_ms, double total_ms);

/// The table of a result.json's text (result_table.h).
std::string result_csv(std::string_view result);

/// Names and values of a sweep's axes.
using AxisValues = std::vector<std::pair<std::string, std::string>>;
/// Returns result.json with "axes" and without times (every one is "not timed"), so that the same setting gives the
/// same bytes. `no_effect`: the axes that the cell's technique does not read. Without `full` it lacks what belongs to the
/// drawing rather than to the cell: the curve of every bias, biases in engines' units, the effects, and what tells of times. They are five sixths
/// of its bytes.
nlohmann::ordered_json line_json(const Comparison& comparison, const AxisValues& axes,
                                 const std::vector<std::string>& no_effect = {}, bool full = true);
/// Which effects the scene calls for, and why the others are not simulated ("effects").
nlohmann::ordered_json effects_json(const EffectPlan& plan);
/// Returns a document on one line, which ends with a line break.
std::string on_one_line(const nlohmann::ordered_json& json);
/// Returns the text of line_json().
std::string result_line(const Comparison& comparison, const AxisValues& axes);
/// The object "axes" of that line, as its JSON text.
std::string axes_text(const AxisValues& axes);
/// How a cell was made.
struct CellMade {
  bool derived = false;  ///< from the gaps of the last drawn frame, whose times are the cell's
  double ms = 0.0;       ///< what making it took
  std::size_t view = 0;  ///< of those that it is judged from, the one whose times these are
};
/// Returns the times that belong to a cell's line.
nlohmann::ordered_json cell_times_json(const Comparison& comparison, std::size_t cell, const CellMade& made);

// The channels of a comparison's EXR files, of a whole picture or of some of its rows.

/// What one light's channels are taken from; all images have one size.
struct AovRows {
  const World& world;
  const raster::RasterFrame& raster;
  const raster::LightRecord& record;
  const raytrace::RayTracedFrame& raytraced;
  const std::array<Image<float>, rung_count>& rungs;
  const Image<Label>& labels;
};
std::vector<Channel> aov_channels(const AovRows& rows);

using AovAttributes = std::array<std::pair<std::string, std::string>, 5>;
AovAttributes aov_attributes(const Comparison& comparison, const LightComparison& light);

}  // namespace gnomon::compare
