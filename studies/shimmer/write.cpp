#include "studies/shimmer/outputs.h"

#include <fmt/core.h>

#include "scene/base/stages.h"
#include "scene/files/path_status.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::studies {
namespace {

Expected<void> write_films(const FilmRecorder& films, const std::string& folder, FilmFormat format,
                           double pixels) {
  for (std::size_t i = 0; i < films.lights().size(); ++i) {
    const FilmOfLight& film = films.lights()[i];
    for (const auto& [name, one] : {std::pair("drawn", &film.drawn), std::pair("truth", &film.truth),
                                    std::pair("flips", &film.flipped)}) {
      const auto bytes = one->file();
      if (!bytes) return fail(bytes.error());
      const std::string base = fmt::format("{}/film-{}-{}", folder, i, name);
      if (const auto written = write_file(base + ".png", *bytes); !written) return written;
      if (format == FilmFormat::apng) continue;
      if (const auto made = convert_to_mp4(base + ".png", base + ".mp4", pixels); !made) return made;
      if (const auto gone = remove_path(base + ".png"); !gone) return gone;
    }
  }
  return {};
}

}  // namespace

Expected<double> write_shimmer(const Shimmer& shimmer, const FilmRecorder& films, const std::string& json,
                               const ShimmerFolder& output) {
  const TimedStage stage("page");
  const auto page = shimmer_page(shimmer, films, json, output.report_max_mb, output.film);
  if (!page) return fail(page.error());
  auto staged = StagedFolder::open(output.folder);
  if (!staged) return fail(staged.error());
  const std::string& folder = staged->path();
  const double pixels =
      double(shimmer.options.time.frames) * double(shimmer.options.compare.raster.size.pixels());
  if (const auto written = write_films(films, folder, output.film, pixels); !written)
    return fail(written.error());
  for (const report::PageFile& file : page->files) {
    if (const auto made = make_output_folder(folder + "/" + file.name.substr(0, file.name.rfind('/'))); !made)
      return fail(made.error());
    if (const auto written = write_file(folder + "/" + file.name, file.bytes); !written)
      return fail(written.error());
  }
  if (const auto written = write_file(folder + "/result.json", json); !written) return fail(written.error());
  if (const auto written = write_file(folder + "/report.html", page->html); !written)
    return fail(written.error());
  StagedFiles also;
  if (const auto there = also.publish(*staged, "report.html", output.inputs, output.elsewhere); !there)
    return fail(there.error());
  return page->megabytes();
}

}  // namespace gnomon::studies
