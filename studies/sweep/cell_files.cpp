#include "studies/sweep/cell_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>
#include <regex>

#include "report/pixels/packing.h"
#include "report/shell.h"
#include "scene/files/encodings.h"
#include "scene/files/folder.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"
#include "studies/sweep/journal.h"

namespace gnomon::studies {
namespace {

constexpr std::string_view truth_prefix = "truth-";
constexpr std::size_t truth_digits = 12;

}  // namespace

bool has_thumbnail(std::size_t cell, std::size_t cells) {
  if (cells <= max_thumbnails) return true;
  // Cell i is the k-th chosen where floor(k * cells / max) = i.
  const std::size_t k = (cell * max_thumbnails + cells - 1) / cells;
  return k < max_thumbnails && k * cells / max_thumbnails == cell;
}

std::string thumbnail_name(std::size_t cell) {
  return fmt::format("{}/{}.png", thumbnails_name, cell_name(cell));
}

std::string thumbnail_path(const std::string& folder, std::size_t cell) {
  return fmt::format("{}/{}", folder, thumbnail_name(cell));
}

std::string cells_folder(const std::string& folder) {
  return fmt::format("{}/{}", folder, cells_name);
}

std::string cell_name(std::size_t cell) {
  return fmt::format("cell-{:06}", cell);
}

std::string truth_name(std::string_view png) {
  return std::string(truth_prefix) + sha256_hex(png).substr(0, truth_digits);
}

namespace {

/// The cell that "cell-000012.js" belongs to, in the cells' folder or that of the thumbnails; none of a name that the
/// program would not write.
std::optional<std::size_t> cell_of_file(std::string_view name) {
  constexpr std::string_view prefix = "cell-";
  const std::size_t dot = name.find('.');
  if (!name.starts_with(prefix) || dot == std::string_view::npos) return std::nullopt;
  const std::string_view extension = name.substr(dot), stem = name.substr(0, dot);
  std::size_t cell = 0;
  std::from_chars(stem.data() + prefix.size(), stem.data() + stem.size(), cell);
  if ((extension != ".js" && extension != ".png") || stem != cell_name(cell)) return std::nullopt;
  return cell;
}

bool is_truth(std::string_view name) {
  constexpr std::string_view end = ".png";
  return name.size() == truth_prefix.size() + truth_digits + end.size() && name.starts_with(truth_prefix) &&
         name.ends_with(end) &&
         name.find_first_not_of("0123456789abcdef", truth_prefix.size()) == name.size() - end.size();
}

/// What a process that is no more left of a file that a sweep writes.
bool is_unfinished(std::string_view name) {
  const std::string of = abandoned_part_of(name);
  return !of.empty() &&
         (of == probe_name || cell_of_file(of) || is_truth(of) ||
          std::find(sweep_file_names.begin(), sweep_file_names.end(), of) != sweep_file_names.end());
}

/// The folder need not be there. `unwanted` is asked of the names in it.
Expected<void> remove_files(const std::string& folder,
                            const std::function<bool(const std::string&)>& unwanted) {
  const auto names = names_if_there(folder, ErrorKind::cannot_write);
  if (!names) return fail(names.error());
  if (names->empty()) return {};
  const auto opened = Folder::at(folder);
  if (!opened) return fail(opened.error());
  for (const std::string& name : *names) {
    if (!unwanted(name)) continue;
    const auto found = opened->find(name);
    if (!found) return fail(found.error());
    if (!*found || !S_ISREG((*found)->st_mode)) continue;  // a link is nobody's leftover
    if (auto gone = remove_path(opened->path_of(name)); !gone) return gone;
  }
  return {};
}

/// Whether the file is a ray-traced picture that a sweep wrote: it is named after what it holds.
bool is_own_truth(const std::string& folder, const std::string& name) {
  if (!is_truth(name)) return false;
  const auto png = read_file(folder + "/" + name);
  return png && truth_name(*png) + ".png" == name;
}

/// Removes a sweep's page or list of the ray tracer's; one of another command is replaced as any output is.
Expected<void> remove_if_own(const std::string& folder, std::string_view name) {
  const auto file = OwnFile::open(folder, name, false);
  if (!file) return fail(file.error());
  return file->is_open() && file->text() ? remove_path(file->path()) : Expected<void>{};
}

}  // namespace

bool is_cell_picture(std::string_view name) {
  return cell_of_file(name) || is_truth(name);
}

Expected<std::vector<std::string>> cell_pictures_in(const std::string& folder) {
  std::vector<std::string> found;
  for (const std::string_view pictures : sweep_folder_names) {
    const auto names = names_if_there(path_in(folder, pictures), ErrorKind::cannot_write);
    if (!names) return fail(names.error());
    for (const std::string& name : *names)
      if (is_cell_picture(name)) found.push_back(path_in(path_in(folder, pictures), name));
  }
  return found;
}

Expected<std::vector<std::string>> truths_in(const std::string& folder) {
  auto names = names_if_there(cells_folder(folder));
  if (names) std::erase_if(*names, [](const std::string& name) { return !is_truth(name); });
  return names;
}

Expected<void> remove_strays(const std::string& folder, std::span<const std::size_t> unfinished) {
  const auto stray = [&](const std::string& name) {
    const auto cell = cell_of_file(name);
    return is_unfinished(name) || (cell && std::binary_search(unfinished.begin(), unfinished.end(), *cell));
  };
  if (auto gone = remove_files(folder, is_unfinished); !gone) return gone;
  for (const std::string& pictures : {folder + "/thumbnails", cells_folder(folder)})
    if (auto gone = remove_files(pictures, stray); !gone) return gone;
  return {};
}

Expected<void> discard_sweep(const std::string& folder) {
  const auto claim = SweepClaim::of(folder);
  if (!claim) return fail(claim.error());
  const auto cells = cells_of_sweep(folder);
  if (!cells) return fail(cells.error());
  if (auto own = check_own_files(folder, cells->has_value()); !own) return own;
  for (const std::string_view name : sweep_folder_names) {
    const std::string pictures = path_in(folder, name);
    const auto ours = [&](const std::string& file) {
      const auto cell = cell_of_file(file);
      return is_unfinished(file) || (cell && *cell < cells->value_or(0)) || is_own_truth(pictures, file);
    };
    if (auto gone = remove_files(pictures, ours); !gone) return gone;
    const auto others = names_if_there(pictures, ErrorKind::cannot_write);
    if (!others) return fail(others.error());
    if (!others->empty()) continue;
    if (auto gone = remove_path(pictures); !gone) return gone;
  }
  if (auto gone = remove_files(folder, is_unfinished); !gone) return gone;
  for (const std::string_view name : sweep_file_names) {
    const bool checked = name.starts_with("sweep");
    if (auto gone = checked ? remove_path(path_in(folder, name)) : remove_if_own(folder, name); !gone)
      return gone;
  }
  return {};
}

// A page that is too large to hold the data loads the file as a script: whatever else stood in it would be run.
bool is_cell_data(std::size_t cell, std::string_view file) {
  static const std::regex head(
      R"(\{"width":\d{1,6},"height":\d{1,6},"truth":"[0-9a-z-]{0,64}","classes":\{"bytes":1,"from":"nothing","data":")");
  constexpr std::size_t longest_head = 256;
  constexpr std::string_view end = "\"}}";
  const std::string_view data = report::data_in_file(file);
  const std::string start(data.substr(0, longest_head));
  std::smatch found;
  if (!std::regex_search(start, found, head, std::regex_constants::match_continuous)) return false;
  std::string_view packed = data.substr(static_cast<std::size_t>(found.length()));
  if (!packed.ends_with(end)) return false;
  packed.remove_suffix(end.size());
  const auto ends_text = [](char c) { return c < ' ' || c > '~' || c == '"' || c == '\\'; };
  return std::none_of(packed.begin(), packed.end(), ends_text) &&
         file == report::data_file({cell_name(cell), std::string(data)});
}

Error not_cell_data(const std::string& path) {
  return {ErrorKind::bad_input, "is no data of that cell as a sweep writes it, and a page would run it",
          path};
}

std::string cell_data_file(std::size_t cell, const Image<std::uint8_t>& codes, const std::string& truth) {
  const std::string classes = report::packed({codes.data.begin(), codes.data.end()}, {1});
  return report::data_file(
      {cell_name(cell),
       fmt::format(
           R"({{"width":{},"height":{},"truth":"{}","classes":{{"bytes":1,"from":"nothing","data":"{}"}}}})",
           codes.size.width, codes.size.height, truth, classes)});
}

}  // namespace gnomon::studies
