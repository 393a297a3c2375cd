#include "compare/sweep/cell_files.h"

#include <fmt/format.h>

#include "compare/report/packing.h"
#include "compare/report/shell.h"
#include "scene/files/sha256.h"

namespace gnomon::compare {

bool has_thumbnail(std::size_t cell, std::size_t cells) {
  if (cells <= max_thumbnails) return true;
  // Cell i is the k-th chosen where floor(k * cells / max) = i.
  const std::size_t k = (cell * max_thumbnails + cells - 1) / cells;
  return k < max_thumbnails && k * cells / max_thumbnails == cell;
}

std::string thumbnail_path(const std::string& folder, std::size_t cell) {
  return fmt::format("{}/thumbnails/{}.png", folder, cell_name(cell));
}

std::string cells_folder(const std::string& folder) {
  return folder + "/cells";
}

std::string cell_name(std::size_t cell) {
  return fmt::format("cell-{:06}", cell);
}

std::string truth_name(std::string_view png) {
  return "truth-" + sha256_hex(png).substr(0, 12);
}

std::string cell_data_file(std::size_t cell, const Image<std::uint8_t>& codes, const std::string& truth) {
  const std::string classes = packed({codes.data.begin(), codes.data.end()}, {1, From::nothing, 1});
  return data_file(
      {cell_name(cell),
       fmt::format(
           R"({{"width":{},"height":{},"truth":"{}","classes":{{"bytes":1,"from":"nothing","data":"{}"}}}})",
           codes.size.width, codes.size.height, truth, classes)});
}

}  // namespace gnomon::compare
