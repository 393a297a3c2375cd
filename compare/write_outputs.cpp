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

std::vector<File> picture_files(const PictureSet& pictures) {
  std::vector<File> files{{pictures.raster.file_name, pictures.raster.png},
                          {pictures.raytraced.file_name, pictures.raytraced.png}};
  for (const LightPictures& light : pictures.lights)
    for (const EncodedPicture* picture : {&light.difference, &light.labels, &light.depth_map})
      files.push_back({picture->file_name, picture->png});
  return files;
}

}  // namespace

Expected<std::vector<std::string>> write_outputs(const Comparison& comparison, const std::string& folder) {
  const Stopwatch watch;
  if (const Expected<void> made = make_output_folder(folder); !made) return fail(made.error());
  const Expected<PictureSet> pictures = encode_pictures(comparison);
  if (!pictures) return fail(pictures.error());

  // What the files say about the time of their own making: up to the point where their text is fixed.
  const double report_ms = comparison.report_ms + watch.elapsed_ms();
  const double total_ms = comparison.total_ms + watch.elapsed_ms();
  const std::string json = result_json(comparison, report_ms, total_ms);
  const std::string csv = result_csv(comparison);
  const std::string page = report_page({comparison, *pictures, json, csv, total_ms});

  std::vector<File> files = picture_files(*pictures);
  files.push_back({"result.json", json});
  files.push_back({"result.csv", csv});
  files.push_back({"report.html", page});
  std::vector<std::string> paths;
  for (const File& file : files) {
    paths.push_back(folder + (folder.ends_with('/') ? "" : "/") + file.name);
    if (const Expected<void> written = write_file(paths.back(), file.bytes); !written)
      return fail(written.error());
  }
  return paths;
}

}  // namespace gnomon::compare
