// Everything that a comparison is written as.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "scene/expected.h"

namespace gnomon::compare {

/// The result file (compare/report/result.schema.json), schema "gnomon/result/1".
std::string result_json(const Comparison& comparison);
/// One row per light: the numbers of result.json as a table; first row names the columns with units.
std::string result_csv(const Comparison& comparison);
/// The summary for stdout, at most 80 columns wide; colour only when asked for.
std::string summary_table(const Comparison& comparison, bool colour);
/// One plain sentence on one light: how many pixels are wrong, mostly why, and what the best bias would
/// leave.
std::string verdict_sentence(const Comparison& comparison, const LightComparison& light);

/// Fixed, labelled, colour-blind-safe colours; the same in every image, page and window.
glm::u8vec3 label_colour(Label label);

Rgb8Image raster_picture(const Comparison& comparison);
Rgb8Image raytraced_picture(const Comparison& comparison);
/// The picture in grey with false shadow and missed shadow in two fixed colours.
Rgb8Image difference_picture(const Comparison& comparison, const LightComparison& light);
Rgb8Image label_picture(const Comparison& comparison, const LightComparison& light);
/// Stored depths, near = bright, on one fixed scale over the map's depth range (logarithmic for a
/// perspective map); cube faces in two rows, +x -x +y above -y +z -z.
Rgb8Image depth_map_picture(const raster::ShadowMap& map);

/// The EXR channels of DESIGN.md section 6; with several lights the light's name goes before ".exr".
Expected<void> write_aov(const Comparison& comparison, const std::string& path);

/// The whole report page: one file, offline, readable without scripts.
Expected<std::string> report_html(const Comparison& comparison);

/// Writes report.html, result.json, result.csv and the PNG pictures into a folder; returns the paths. The
/// times "report" and "total" in these files are the comparison's own plus the time spent here until their
/// text is fixed.
Expected<std::vector<std::string>> write_outputs(const Comparison& comparison, const std::string& folder);

}  // namespace gnomon::compare
