#include "compare/sweep/cell_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <vector>

#include "compare/report/packing.h"
#include "compare/report/shell.h"
#include "compare/sweep/journal.h"
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

namespace {

namespace fs = std::filesystem;

/// The cell that "cell-000012.js" belongs to.
std::optional<std::size_t> cell_of_file(const fs::path& file) {
  const std::string stem = file.stem().string(), extension = file.extension().string();
  if (!stem.starts_with("cell-") || (extension != ".js" && extension != ".png")) return std::nullopt;
  std::size_t cell = 0;
  const auto [end, status] = std::from_chars(stem.data() + 5, stem.data() + stem.size(), cell);
  if (status != std::errc() || end != stem.data() + stem.size()) return std::nullopt;
  return cell;
}

template <class Unwanted>
void remove_files(const fs::path& folder, const Unwanted& unwanted) {
  std::error_code error;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && unwanted(entry.path().filename())) found.push_back(entry.path());
  for (const fs::path& file : found) fs::remove(file, error);
}

bool is_unfinished(const fs::path& name) {
  return name.extension() == ".part";
}

}  // namespace

void remove_strays(const std::string& folder, std::span<const std::size_t> finished) {
  const auto stray = [&](const fs::path& name) {
    const auto cell = cell_of_file(name);
    return is_unfinished(name) || (cell && !std::binary_search(finished.begin(), finished.end(), *cell));
  };
  remove_files(folder, is_unfinished);
  for (const std::string& pictures : {folder + "/thumbnails", cells_folder(folder)})
    remove_files(pictures, stray);
}

Expected<void> discard_sweep(const std::string& folder) {
  std::error_code error;
  for (const std::string_view name : sweep_file_names) {
    fs::remove(fs::path(folder) / name, error);
    if (error) return fail(Error{ErrorKind::cannot_write, "cannot remove: " + error.message(), folder});
  }
  const auto ours = [](const fs::path& name) {
    return is_unfinished(name) || cell_of_file(name) ||
           (name.string().starts_with("truth-") && name.extension() == ".png");
  };
  for (const std::string& pictures : {folder + "/thumbnails", cells_folder(folder)}) {
    remove_files(pictures, ours);
    fs::remove(pictures, error);  // stays where something else lies in it
  }
  return {};
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
