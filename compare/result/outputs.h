// The texts and pictures that a comparison is written as.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison.h"
#include "scene/base/expected.h"
#include "scene/base/stages.h"

namespace gnomon::compare {

/// The result file (compare/result/result_schema.h), schema "gnomon/result/1".
std::string result_json(const Comparison& comparison);
/// One row per light: the numbers and times of result.json as a table (result_table.h).
std::string result_csv(const Comparison& comparison);
/// Everything that a terminal is told of a comparison, at most 80 columns wide; colour only when asked for.
std::string summary_table(const Comparison& comparison, bool colour);
/// Says in short what is wrong and what would help: known before anything is timed or written.
std::string verdict_in_short(const Comparison& comparison, bool colour);
/// Says what follows the verdict: a few lines of figures, and `place`, where the report is.
std::string figures_in_short(const Comparison& comparison, std::string_view place, bool colour);

/// Fixed, labelled, colour-blind-safe colours; the same in every image, page and window.
glm::u8vec3 label_colour(Label label);

Rgb8Image raster_picture(const Comparison& comparison);
Rgb8Image raytraced_picture(const Comparison& comparison);
/// The picture in grey with false shadow and missed shadow in two fixed colours.
Rgb8Image difference_picture(const Comparison& comparison, const LightComparison& light);
/// From raster_picture(), where that has been made.
Rgb8Image difference_picture(const Rgb8Image& drawn, const LightComparison& light);
/// Each error in the colour of its label, as strong as it is; grey where all is right.
Rgb8Image label_picture(const LightComparison& light);
/// One pixel of it: its truth is shadow (one half and less lit) or not, and it errs by so much.
glm::u8vec3 label_pixel(Label label, bool truly_dark, float error);
/// |V6 - V0|, FLIP and 1 - SSIM of the visibility pictures, each on magma from 0 to 1; black where nothing is
/// compared. FLIP and SSIM need the light's maps.
Rgb8Image error_picture(const LightComparison& light);
Rgb8Image flip_picture(const LightComparison& light);
Rgb8Image ssim_picture(const LightComparison& light);
/// Shows who decided each pixel of the hybrid: the picture in grey, tinted where the sheets were sure, one plain colour
/// where rays were cast. It needs the record's decisions.
Rgb8Image decision_picture(const Comparison& comparison, const LightComparison& light);
/// How far drawn shadow edges lie from the true ones, on the band between the two. The colours go from white
/// (none) to those of false shadow (the drawn shadow is larger) and missed shadow (smaller) at
/// edge_scale_texels and more. Grey: lit and shadowed, where no edge was measured. Needs the light's map.
Rgb8Image edge_picture(const LightComparison& light);
/// How far the drawn shadow starts from its caster, on the pixels that the bias lights there, on magma from
/// 0 to detachment_scale_texels; black elsewhere. Needs the light's map.
Rgb8Image detachment_picture(const LightComparison& light);
inline constexpr double edge_scale_texels = 4.0, detachment_scale_texels = 16.0;
/// Stored depths, near = bright, on one fixed scale over the map's depth range (logarithmic for a
/// perspective map); cube faces in two rows, +x -x +y above -y +z -z.
Rgb8Image depth_map_picture(const raster::ShadowMap& map);

/// The EXR channels of docs/manual/aov.md, of each light in its own place.
Expected<void> write_aov(const Comparison& comparison, std::span<const std::string> places);

// The time budget of a run in the words of the outputs: every stage with its wall-clock and its processor
// time, summing to the process.

/// `document` (a JSON object, indented by 2) with the keys "process" and "time_budget" added at its end.
std::string with_time_budget(std::string document, const TimeBudget& budget);
/// Adds the time of this thread's StageLog up to now; the document is unchanged where there is none.
std::string with_time_budget(std::string document);

/// For the terminal, at most 80 columns wide: the whole and what takes most of it.
std::string time_budget_text(const TimeBudget& budget, bool colour);

}  // namespace gnomon::compare
