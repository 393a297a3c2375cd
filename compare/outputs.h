// Everything that a comparison is written as.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison.h"
#include "scene/expected.h"
#include "scene/files/staged_folder.h"

namespace gnomon::compare {

struct PageIntroduction;  // report/page.h
struct BandedParts;       // measure/measure.h

/// The result file (compare/report/result.schema.json), schema "gnomon/result/1".
std::string result_json(const Comparison& comparison);
/// One row per light: the numbers and times of result.json as a table (result_table.h).
std::string result_csv(const Comparison& comparison);
/// The summary for stdout, at most 80 columns wide; colour only when asked for.
std::string summary_table(const Comparison& comparison, bool colour);

/// Fixed, labelled, colour-blind-safe colours; the same in every image, page and window.
glm::u8vec3 label_colour(Label label);

Rgb8Image raster_picture(const Comparison& comparison);
Rgb8Image raytraced_picture(const Comparison& comparison);
/// The picture in grey with false shadow and missed shadow in two fixed colours.
Rgb8Image difference_picture(const Comparison& comparison, const LightComparison& light);
/// From raster_picture(), where that has been made.
Rgb8Image difference_picture(const Rgb8Image& drawn, const LightComparison& light);
Rgb8Image label_picture(const LightComparison& light);
/// |V6 - V0|, FLIP and 1 - SSIM of the visibility pictures, each on magma from 0 to 1; black where nothing is
/// compared. FLIP and SSIM need the light's maps.
Rgb8Image error_picture(const LightComparison& light);
Rgb8Image flip_picture(const LightComparison& light);
Rgb8Image ssim_picture(const LightComparison& light);
/// Of the hybrid, who decided each pixel: the picture in grey, tinted where the sheets were sure, one plain
/// colour where rays were cast. Needs the record's decisions.
Rgb8Image decision_picture(const Comparison& comparison, const LightComparison& light);
/// How far drawn shadow edges lie from the true ones, on the band between the two: from white (none) to the
/// colours of false shadow (the drawn shadow is larger) and missed shadow (smaller) at edge_scale_texels and
/// more. Grey: lit and shadowed, where no edge was measured. Needs the light's map.
Rgb8Image edge_picture(const LightComparison& light);
/// How far the drawn shadow starts from its caster, on the pixels that the bias lights there, on magma from
/// 0 to detachment_scale_texels; black elsewhere. Needs the light's map.
Rgb8Image detachment_picture(const LightComparison& light);
inline constexpr double edge_scale_texels = 4.0, detachment_scale_texels = 16.0;
/// Stored depths, near = bright, on one fixed scale over the map's depth range (logarithmic for a
/// perspective map); cube faces in two rows, +x -x +y above -y +z -z.
Rgb8Image depth_map_picture(const raster::ShadowMap& map);

/// The EXR channels of docs/design.md, section 6; with several lights the light's name goes before ".exr".
Expected<void> write_aov(const Comparison& comparison, const std::string& path);

/// The whole report page: one file, offline, readable without scripts.
Expected<std::string> report_html(const Comparison& comparison);

inline constexpr double default_report_max_mb = 40.0;  ///< megabytes, of a page that is one file

struct WrittenOutputs {
  std::vector<std::string> paths;  ///< names in the folder, until the folder is in its place
  std::string result;              ///< the text of result.json, until it is written without its time budget
  bool beside = false;  ///< the page's pictures and pixels are files beside it: it would have grown too large
  double page_mb = 0.0;             ///< what the page, or the page with the files beside it, weighs
  bool page = true;                 ///< OutputFolder's
  std::vector<std::string> inputs;  ///< OutputFolder's
  std::string folder;               ///< OutputFolder's
  StagedFolder staged;              ///< where the files are until then
};

/// Files that a comparison's folder always has.
inline constexpr std::array<std::string_view, 5> page_file_names{"report.html", "result.json", "result.csv",
                                                                 "raster.png", "raytrace.png"};

struct OutputFile {
  std::string name, bytes;
};

struct OutputFolder {
  std::string folder;
  double report_max_mb = default_report_max_mb;    ///< a larger page keeps pictures and pixels beside it
  const PageIntroduction* introduction = nullptr;  ///< what stands before the comparison on the page
  std::vector<OutputFile> more{};                  ///< further files of the folder
  bool page = true;                                ///< false: no report.html, and nothing is made for it
  std::vector<std::string> inputs{};               ///< files that must not be replaced: ErrorKind::usage
};

/// Writes report.html, result.json, result.csv and the PNG pictures into a folder, which appears whole
/// (scene/files/staged_folder.h). The times "report" and "total" in these files are the comparison's own plus
/// the time spent here until their text is fixed.
Expected<WrittenOutputs> write_outputs(const Comparison& comparison, OutputFolder output);

/// The first of two steps that write_outputs() is made of: all but result.json. `parts`: of a comparison that was made
/// in bands; null: of any other.
Expected<WrittenOutputs> write_all_but_result(const Comparison& comparison, BandedParts* parts,
                                              OutputFolder output);

/// The last of two steps (the first: write_all_but_result()), so that the time budget in
/// result.json holds what the other files took and whatever is done in between. Where no StageLog runs it has none. The
/// folder is in its place afterwards.
Expected<void> write_result(WrittenOutputs& written);

}  // namespace gnomon::compare
