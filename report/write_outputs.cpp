// The output folder: pictures first, then the table, then the page; result.json last, which tells what all of
// that took. They are written beside the folder's place and moved there whole (scene/files/staged_folder.h).
#include "report/write_outputs.h"

#include <filesystem>
#include <optional>

#include "compare/measure/measure.h"
#include "compare/measure/reduced.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/picture_set.h"
#include "report/page.h"
#include "report/pixels/page_data.h"
#include "scene/base/threads.h"
#include "scene/files/write_file.h"

namespace gnomon::report {
namespace {

using compare::Comparison;
using compare::PictureSet;

struct File {
  std::string name;
  std::string_view bytes;
};

std::vector<File> picture_files(const PictureSet& pictures) {
  std::vector<File> files{{pictures.raster.file_name, pictures.raster.png},
                          {pictures.raytraced.file_name, pictures.raytraced.png}};
  for (const compare::LightPictures& light : pictures.lights) {
    for (const compare::EncodedPicture* picture :
         {&light.difference, &light.labels, &light.error, &light.flip, &light.ssim, &light.edges,
          &light.detachment, &light.decisions, &light.depth_map})
      if (!picture->png.empty()) files.push_back({picture->file_name, picture->png});
  }
  return files;
}

/// The page last; before it what only the page shows, if it has files beside it, and the table.
std::vector<File> other_files(const PictureSet& pictures, const BuiltPage& page, std::string_view csv) {
  std::vector<File> files;
  for (const compare::LightPictures& light : pictures.lights)
    if (!page.files.empty() && light.depth_map_small.file_name != light.depth_map.file_name)
      files.push_back({light.depth_map_small.file_name, light.depth_map_small.png});
  for (const PageFile& file : page.files) files.push_back({file.name, file.bytes});
  files.push_back({"result.csv", csv});
  if (!page.html.empty()) files.push_back({"report.html", page.html});
  return files;
}

using Names = std::vector<std::string>;

Expected<Names> write_files(const std::string& folder, const std::vector<File>& files) {
  Names names;
  for (const File& file : files) {
    names.push_back(file.name);
    if (const Expected<void> written = write_file(folder + "/" + file.name, file.bytes); !written)
      return fail(written.error());
  }
  return names;
}

Expected<void> make_folders(const std::string& folder, const BuiltPage& page) {
  for (const PageFile& file : page.files)
    if (const auto made = make_output_folder(folder + "/" + file.name.substr(0, file.name.rfind('/'))); !made)
      return made;
  return {};
}

/// What result.json and the page say, as far as it is known before they are written.
struct Texts {
  std::string result;  ///< without its time budget
  std::string csv;
  BuiltPage page;
};

Texts make_texts(const Comparison& comparison, const compare::BandedParts* parts, const PictureSet& pictures,
                 const OutputFolder& output, const Stopwatch& watch) {
  // Bands leave only the images that the page has room for.
  const int step = parts != nullptr ? 1 : compare::image_step(comparison.raster.options.size);
  std::optional<Comparison> reduced;
  if (output.page && step > 1) reduced = compare::reduced_images(comparison, step);
  PageInput input{reduced ? *reduced : comparison, pictures, {}, {}, output.introduction};
  PageData data;
  if (output.page) data = page_data(input);
  // What the files say about the time of their own making: up to the point where their text is fixed.
  const double report_ms = comparison.report_ms + watch.elapsed_ms();
  const double total_ms = comparison.total_ms + watch.elapsed_ms();
  Texts out{compare::result_json(comparison, report_ms, total_ms), {}, {}};
  out.csv = compare::result_csv(out.result);
  if (!output.page) return out;
  const StageLog* log = StageLog::current();
  const std::string json = log != nullptr ? compare::with_time_budget(out.result, log->budget()) : out.result;
  input.json = json, input.csv = out.csv;
  out.page = report_page(input, data, output.report_max_mb);
  return out;
}

}  // namespace

Expected<WrittenOutputs> write_all_but_result(const Comparison& comparison, compare::BandedParts* parts,
                                              OutputFolder output) {
  const Stopwatch watch;
  auto staged = StagedFolder::open(output.folder);
  if (!staged) return fail(staged.error());
  const std::string folder = staged->path();
  TimedStage encoding("pictures");
  const Expected<PictureSet> pictures =
      compare::encode_pictures(comparison, parts != nullptr ? &parts->pictures : nullptr);
  if (parts != nullptr) parts->pictures = compare::PictureStore({}, 0);
  encoding.end();
  if (!pictures) return fail(pictures.error());
  // Waiting for the disk, while the page is made.
  auto written_pictures = in_background([&] { return write_files(folder, picture_files(*pictures)); });

  TimedStage making(output.page ? "page" : "write");
  Texts texts = make_texts(comparison, parts, *pictures, output, watch);
  making.end();

  const TimedStage writing("write");
  Expected<Names> names = written_pictures.get();
  if (!names) return fail(names.error());
  if (const auto made = make_folders(folder, texts.page); !made) return fail(made.error());
  std::vector<File> others = other_files(*pictures, texts.page, texts.csv);
  for (const OutputFile& file : output.more) others.push_back({file.name, file.bytes});
  const Expected<Names> more = write_files(folder, others);
  if (!more) return fail(more.error());
  names->insert(names->end(), more->begin(), more->end());
  return WrittenOutputs{std::move(*names),
                        std::move(texts.result),
                        !texts.page.files.empty(),
                        texts.page.megabytes(),
                        output.page,
                        std::move(output.inputs),
                        std::move(output.folder),
                        std::move(*staged),
                        {},
                        std::move(output.elsewhere)};
}

namespace {

/// Where the text of result.json goes: into the folder, and to the copy's place.
Expected<Names> places_of_result(WrittenOutputs& written) {
  Names places{written.staged.path() + "/result.json"};
  if (written.result_copy.empty()) return places;
  auto copy = written.also.place_of(written.result_copy, &written.staged);
  if (!copy) return fail(copy.error());
  if (*copy != written.result_copy) places.push_back(std::move(*copy));
  return places;
}

/// Once the disk has all, writes again how long that took: a reading is as long as another.
Expected<void> write_and_seal(WrittenOutputs& written, const Names& places) {
  const auto with_times = [&] { return compare::with_time_budget(written.result); };
  TimedStage writing("write");
  const std::string early = with_times();
  for (const std::string& place : places)
    if (auto there = write_file(place, early); !there) return there;
  for (const FileText& file : written.elsewhere)
    if (auto there = written.also.write(file, &written.staged); !there) return there;
  if (auto sealed = written.also.seal(); !sealed) return sealed;
  if (auto sealed = written.staged.seal(written.inputs); !sealed) return sealed;
  writing.end();
  const std::string late = with_times();
  for (const std::string& staged : places) {
    const std::string place = written.also.sealed_place(staged);
    auto amended = late.size() == early.size()
                       ? write_over_end(place, std::string_view(late).substr(written.result.rfind("\n}")))
                       : write_file(place, late);
    if (!amended) return amended;
  }
  written.result = late;
  return {};
}

}  // namespace

Expected<void> write_result(WrittenOutputs& written) {
  const auto places = places_of_result(written);
  if (!places) return fail(places.error());
  if (auto sealed = write_and_seal(written, *places); !sealed) return sealed;
  written.paths.push_back("result.json");
  const char* const last = written.page ? "report.html" : "result.json";
  if (auto there = written.also.publish(&written.staged, last); !there) return there;
  if (places->size() == 1 && !written.result_copy.empty())  // a device or a pipe
    if (auto there = write_file(written.result_copy, written.result); !there) return there;
  for (std::string& name : written.paths) name = (std::filesystem::path(written.folder) / name).string();
  return {};
}

Expected<WrittenOutputs> write_outputs(const Comparison& comparison, OutputFolder output) {
  auto written = write_all_but_result(comparison, nullptr, std::move(output));
  if (!written) return written;
  if (const auto result = write_result(*written); !result) return fail(result.error());
  return written;
}

}  // namespace gnomon::report
