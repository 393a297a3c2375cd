// The output folder of a comparison: page, tables and pictures, which appear whole or not at all.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "compare/result/outputs.h"
#include "scene/files/staged_files.h"
#include "scene/files/staged_folder.h"

namespace gnomon::compare {
struct BandedParts;  // compare/measure/measure.h
}

namespace gnomon::report {

struct PageIntroduction;  // report/page.h

/// The whole report page: one file, offline, readable without scripts.
Expected<std::string> report_html(const compare::Comparison& comparison);

inline constexpr double default_report_max_mb = 40.0;  ///< megabytes, of a page that is one file

struct WrittenOutputs {
  std::vector<std::string> paths;  ///< names in the folder, until the folder is in its place
  std::string result;              ///< the text of result.json, until it is written without its time budget
  bool beside = false;  ///< the page's pictures and pixels are files beside it: it would have grown too large
  double page_mb = 0.0;               ///< what the page, or the page with the files beside it, weighs
  bool page = true;                   ///< OutputFolder's
  std::vector<std::string> inputs;    ///< OutputFolder's
  std::string folder;                 ///< OutputFolder's
  StagedFolder staged;                ///< where the files are until then
  StagedFiles also{};                 ///< what appears with the folder, elsewhere
  std::vector<FileText> elsewhere{};  ///< OutputFolder's
  std::string result_copy{};          ///< a file that gets the bytes of result.json; "": none
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
  std::vector<FileText> elsewhere{};               ///< files that appear with the folder, wherever they lie
};

/// Writes report.html, result.json, result.csv and the PNG pictures into a folder, which appears whole
/// (scene/files/staged_folder.h). The times "report" and "total" in these files are the comparison's own plus
/// the time spent here until their text is fixed.
Expected<WrittenOutputs> write_outputs(const compare::Comparison& comparison, OutputFolder output);

/// The first of two steps that write_outputs() is made of: all but result.json. `parts`: of a comparison that was made
/// in bands; null: of any other.
Expected<WrittenOutputs> write_all_but_result(const compare::Comparison& comparison,
                                              compare::BandedParts* parts, OutputFolder output);

/// The last of two steps (the first: write_all_but_result()), so that the time budget in
/// result.json holds what the other files took and whatever is done in between. Where no StageLog runs it has none. The
/// folder is in its place afterwards, and what appears with it in its own.
Expected<void> write_result(WrittenOutputs& written);

}  // namespace gnomon::report
