// The output folder: pictures first, then the table, then the page, so that a page always finds its files
// beside it; result.json last, which tells what all of that took. Each file appears whole or not at all
// (scene/files/write_file.h).
#include <future>

#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "compare/picture_set.h"
#include "compare/report/page.h"
#include "compare/report/page_data.h"
#include "compare/time_budget.h"
#include "scene/files/write_file.h"

namespace gnomon::compare {
namespace {

struct File {
  std::string name;
  std::string_view bytes;
};

std::vector<File> picture_files(const PictureSet& pictures) {
  std::vector<File> files{{pictures.raster.file_name, pictures.raster.png},
                          {pictures.raytraced.file_name, pictures.raytraced.png}};
  for (const LightPictures& light : pictures.lights) {
    for (const EncodedPicture* picture :
         {&light.difference, &light.labels, &light.error, &light.flip, &light.ssim, &light.edges,
          &light.detachment, &light.decisions, &light.depth_map})
      if (!picture->png.empty()) files.push_back({picture->file_name, picture->png});
  }
  return files;
}

/// The page last; before it what only the page shows, if it has files beside it, and the table.
std::vector<File> other_files(const PictureSet& pictures, const BuiltPage& page, std::string_view csv) {
  std::vector<File> files;
  for (const LightPictures& light : pictures.lights)
    if (!page.files.empty() && light.depth_map_small.file_name != light.depth_map.file_name)
      files.push_back({light.depth_map_small.file_name, light.depth_map_small.png});
  for (const PageFile& file : page.files) files.push_back({file.name, file.bytes});
  files.push_back({"result.csv", csv});
  files.push_back({"report.html", page.html});
  return files;
}

using Paths = std::vector<std::string>;

Expected<Paths> write_files(const std::string& folder, const std::vector<File>& files) {
  Paths paths;
  for (const File& file : files) {
    paths.push_back(folder + (folder.ends_with('/') ? "" : "/") + file.name);
    if (const Expected<void> written = write_file(paths.back(), file.bytes); !written)
      return fail(written.error());
  }
  return paths;
}

Expected<void> make_folders(const std::string& folder, const BuiltPage& page) {
  for (const PageFile& file : page.files)
    if (const auto made = make_output_folder(folder + "/" + file.name.substr(0, file.name.rfind('/'))); !made)
      return made;
  return {};
}

}  // namespace

Expected<WrittenOutputs> write_all_but_result(const Comparison& comparison, const std::string& folder,
                                              double report_max_mb, const PageIntroduction* introduction) {
  const Stopwatch watch;
  if (const Expected<void> made = make_output_folder(folder); !made) return fail(made.error());
  TimedStage encoding("pictures");
  const Expected<PictureSet> pictures = encode_pictures(comparison);
  encoding.end();
  if (!pictures) return fail(pictures.error());
  // Waiting for the disk, while the page is made.
  auto written_pictures =
      std::async(std::launch::async, [&] { return write_files(folder, picture_files(*pictures)); });

  TimedStage making("page");
  PageInput input{comparison, *pictures, {}, {}, 0.0, introduction};
  PageData data = page_data(input);
  // What the files say about the time of their own making: up to the point where their text is fixed.
  const double report_ms = comparison.report_ms + watch.elapsed_ms();
  const double total_ms = comparison.total_ms + watch.elapsed_ms();
  std::string result = result_json(comparison, report_ms, total_ms);
  const StageLog* log = StageLog::current();
  const TimeBudget budget = log != nullptr ? log->budget() : TimeBudget{};
  const std::string json = log != nullptr ? with_time_budget(result, budget) : result;
  const std::string csv = result_csv(result);
  input.json = json, input.csv = csv, input.total_ms = total_ms;
  input.budget = log != nullptr ? &budget : nullptr;
  const BuiltPage page = report_page(input, data, report_max_mb);
  making.end();

  const TimedStage writing("write");
  Expected<Paths> paths = written_pictures.get();
  if (!paths) return fail(paths.error());
  if (const auto made = make_folders(folder, page); !made) return fail(made.error());
  const Expected<Paths> others = write_files(folder, other_files(*pictures, page, csv));
  if (!others) return fail(others.error());
  paths->insert(paths->end(), others->begin(), others->end());
  return WrittenOutputs{std::move(*paths), std::move(result), !page.files.empty(), page.megabytes()};
}

Expected<void> write_result(WrittenOutputs& written, const std::string& folder) {
  written.result = with_time_budget(std::move(written.result));
  Expected<Paths> paths = write_files(folder, {{"result.json", written.result}});
  if (!paths) return fail(paths.error());
  written.paths.push_back(std::move(paths->front()));
  return {};
}

Expected<WrittenOutputs> write_outputs(const Comparison& comparison, const std::string& folder,
                                       double report_max_mb, const PageIntroduction* introduction) {
  auto written = write_all_but_result(comparison, folder, report_max_mb, introduction);
  if (!written) return written;
  if (const auto result = write_result(*written, folder); !result) return fail(result.error());
  return written;
}

}  // namespace gnomon::compare
