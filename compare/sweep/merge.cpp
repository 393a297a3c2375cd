#include "compare/sweep/merge.h"

#include <fmt/core.h>

#include <filesystem>
#include <map>
#include <set>

#include "compare/sweep/cell_files.h"
#include "compare/sweep/journal.h"
#include "compare/sweep/page.h"
#include "scene/files/write_file.h"

namespace gnomon::compare {
namespace {

namespace fs = std::filesystem;

struct Cell {
  std::string line, times, folder;
};
using Cells = std::map<std::size_t, Cell>;

Expected<void> add_shard(const std::string& folder, const SweepLines& shard, Cells& cells) {
  const auto summaries = summarise(shard);
  if (!summaries) return fail(summaries.error());
  for (std::size_t i = 0; i < shard.lines.size(); ++i) {
    const std::size_t cell = (*summaries)[i].cell;
    if (!cells.emplace(cell, Cell{shard.lines[i], shard.times[i], folder}).second)
      return fail(ErrorKind::usage, fmt::format("{}: cell {} is in another shard too", folder, cell));
  }
  return {};
}

Expected<void> copy_existing(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::exists(from, error)) return {};
  fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  if (error)
    return fail(Error{ErrorKind::cannot_write, "cannot copy a picture: " + error.message(), to.string()});
  return {};
}

/// The ray-traced pictures, whose names tell them apart.
Expected<void> copy_truths(const std::string& folder, const std::string& target) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(cells_folder(folder), error))
    if (entry.path().filename().string().starts_with("truth-"))
      if (auto copied = copy_existing(entry.path(), fs::path(cells_folder(target)) / entry.path().filename());
          !copied)
        return copied;
  return {};
}

Expected<void> copy_pictures(const Cell& cell, std::size_t index, const std::string& target) {
  const std::string from = cells_folder(cell.folder) + "/" + cell_name(index),
                    to = cells_folder(target) + "/" + cell_name(index);
  const std::vector<std::pair<std::string, std::string>> files{
      {thumbnail_path(cell.folder, index), thumbnail_path(target, index)},
      {from + ".js", to + ".js"},
      {from + ".png", to + ".png"}};
  for (const auto& [source, copy] : files)
    if (auto copied = copy_existing(source, copy); !copied) return copied;
  return {};
}

Expected<void> write_whole(const Cells& cells, const SweepHeader& header, const std::string& target) {
  std::vector<std::string> axes;
  std::vector<std::size_t> indices;
  for (const auto& [index, cell] : cells) {
    axes.push_back(axes_of_line(cell.line));
    indices.push_back(index);
  }
  auto journal =
      Journal::open(target, make_header(header.configuration, header.cells, {}), axes, std::move(indices));
  if (!journal) return fail(journal.error());
  for (const std::string& made_for : {target + "/thumbnails", cells_folder(target)})
    if (auto made = make_output_folder(made_for); !made) return made;
  std::size_t next = 0;
  for (const auto& [index, cell] : cells) {
    if (auto copied = copy_pictures(cell, index, target); !copied) return copied;
    if (next++ < journal->lines().size()) continue;
    if (auto appended = journal->append(cell.line, cell.times); !appended) return appended;
  }
  return {};
}

}  // namespace

Expected<MergedSweep> merge_sweeps(const std::vector<std::string>& folders, const std::string& target,
                                   double report_max_mb, const std::optional<Threshold>& limit) {
  Cells cells;
  std::optional<SweepHeader> header;
  std::set<std::string> drawers;
  for (const std::string& folder : folders) {
    auto shard = read_sweep(folder);
    if (!shard) return fail(shard.error());
    if (!header) header = shard->header;
    if (shard->header.hash != header->hash)
      return fail(ErrorKind::usage, folder + ": a shard of another sweep than " + folders.front());
    if (auto added = add_shard(folder, *shard, cells); !added) return fail(added.error());
    for (const std::string& line : shard->lines) drawers.insert(drawer_of_line(line));
  }
  if (!header) return fail(ErrorKind::usage, "no shard is given");
  if (cells.size() != header->cells)
    return fail(ErrorKind::usage, fmt::format("{} of {} cells are there: a shard is missing or not finished",
                                              cells.size(), header->cells));
  if (auto written = write_whole(cells, *header, target); !written) return fail(written.error());
  for (const std::string& folder : folders) {
    if (auto copied = copy_truths(folder, target); !copied) return fail(copied.error());
    if (auto copied = copy_existing(ray_points_path(folder), ray_points_path(target)); !copied)
      return fail(copied.error());
  }
  const auto page = write_sweep_page(target, report_max_mb, limit);
  if (!page) return fail(page.error());
  return MergedSweep{cells.size(), *page, {drawers.begin(), drawers.end()}};
}

}  // namespace gnomon::compare
