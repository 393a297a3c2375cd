// What the writers of result.json, CSV, summary and report share: the records of one light, and the mean of
// each rung.
#pragma once

#include <array>
#include <string>

#include "compare/comparison.h"

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

/// Mean visibility of each rung over compared pixels; 0 where none is compared.
std::array<double, rung_count> rung_means(const LightComparison& light);

/// A light's name as a part of a file name, unique among the lights compared.
std::string light_file_part(const Comparison& comparison, const LightComparison& light);
/// Where one light's channels go: `path` itself, or with "-NAME" before the extension when there are several
/// lights.
std::string aov_path(const Comparison& comparison, const LightComparison& light, const std::string& path);

/// The text of result.json with these times in place of the comparison's own (the writer knows how long
/// writing took).
std::string result_json(const Comparison& comparison, double report_ms, double total_ms);

}  // namespace gnomon::compare
