// The output folder: pictures first, then the tables, the page last, so that a page always finds its files
// beside it. Each file appears whole or not at all (scene/files/write_file.h).
#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "compare/picture_set.h"
#include "compare/report/page.h"
#include "scene/files/write_file.h"

namespace gnomon::compare {
namespace {

struct File {
  std::string name;
  std::string_view bytes;
};

// `beside`: also those that only the page shows.
std::vector<File> picture_files(const PictureSet& pictures, bool beside) {
  std::vector<File> files{{pictures.raster.file_name, pictures.raster.png},
                          {pictures.raytraced.file_name, pictures.raytraced.png}};
  for (const LightPictures& light : pictures.lights) {
    for (const EncodedPicture* picture :
         {&light.difference, &light.labels, &light.error, &light.flip, &light.ssim, &light.edges,
          &light.detachment, &light.decisions, &light.depth_map})
      if (!picture->png.empty()) files.push_back({picture->file_name, picture->png});
    if (beside && light.depth_map_small.file_name != light.depth_map.file_name)
      files.push_back({light.depth_map_small.file_name, light.depth_map_small.png});
  }
  return files;
}

Expected<void> make_folders(const std::string& folder, const BuiltPage& page) {
  for (const PageFile& file : page.files)
    if (const auto made = make_output_folder(folder + "/" + file.name.substr(0, file.name.rfind('/'))); !made)
      return made;
  return {};
}

}  // namespace

Expected<WrittenOutputs> write_outputs(const Comparison& comparison, const std::string& folder,
                                       double report_max_mb, const PageIntroduction* introduction) {
  const Stopwatch watch;
  if (const Expected<void> made = make_output_folder(folder); !made) return fail(made.error());
  const Expected<PictureSet> pictures = encode_pictures(comparison);
  if (!pictures) return fail(pictures.error());

  // What the files say about the time of their own making: up to the point where their text is fixed.
  const double report_ms = comparison.report_ms + watch.elapsed_ms();
  const double total_ms = comparison.total_ms + watch.elapsed_ms();
  const std::string json = result_json(comparison, report_ms, total_ms);
  const std::string csv = result_csv(comparison);
  const BuiltPage page =
      report_page({comparison, *pictures, json, csv, total_ms, introduction}, report_max_mb);

  std::vector<File> files = picture_files(*pictures, !page.files.empty());
  for (const PageFile& file : page.files) files.push_back({file.name, file.bytes});
  files.push_back({"result.json", json});
  files.push_back({"result.csv", csv});
  files.push_back({"report.html", page.html});
  if (const auto made = make_folders(folder, page); !made) return fail(made.error());
  WrittenOutputs out{{}, !page.files.empty(), page.megabytes()};
  for (const File& file : files) {
    out.paths.push_back(folder + (folder.ends_with('/') ? "" : "/") + file.name);
    if (const Expected<void> written = write_file(out.paths.back(), file.bytes); !written)
      return fail(written.error());
  }
  return out;
}

}  // namespace gnomon::compare
