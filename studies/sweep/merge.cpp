
#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/journal.h"
#include "studies/sweep/page.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

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

/// Where nothing is there is nothing to copy: not every cell has pictures.
Expected<void> copy_if_there(const std::string& from, const std::string& to) {
  const auto there = is_there(from);
  if (!there) return fail(there.error());
  if (!*there) return {};
  const auto bytes = read_file(from);
  return bytes ? write_file(to, *bytes) : fail(bytes.error());
}

/// The ray-traced pictures, whose names tell them apart.
Expected<void> copy_truths(const std::string& folder, const std::string& target) {
  const auto names = truths_in(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names)
    if (auto copied = copy_if_there(cells_folder(folder) + "/" + name, cells_folder(target) + "/" + name);
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
    if (auto copied = copy_if_there(source, copy); !copied) return copied;
  return {};
}

/// The cells in the order of the sweep, as a journal takes them.
struct Lines {
  std::vector<std::size_t> cells;
  std::vector<std::string> axes, lines, times;
};

Lines lines_of(const Cells& cells) {
  Lines all;
  for (const auto& [index, cell] : cells) {
    all.cells.push_back(index);
    all.axes.push_back(axes_of_line(Json::parse(cell.line, nullptr, false)));
    all.lines.push_back(cell.line);
    all.times.push_back(cell.times);
  }
  return all;
}

/// All but the page.
Expected<void> write_whole(const Cells& cells, const Lines& lines, const SweepHeader& header,
                           const std::vector<std::string>& folders, const std::string& target) {
  if (auto written = write_sweep(target, header, lines.cells, lines.lines, lines.times); !written)
    return written;
  for (const std::string& made_for : {target + "/thumbnails", cells_folder(target)})
    if (auto made = make_output_folder(made_for); !made) return made;
  for (const auto& [index, cell] : cells)
    if (auto copied = copy_pictures(cell, index, target); !copied) return copied;
  for (const std::string& folder : folders) {
    if (auto copied = copy_truths(folder, target); !copied) return copied;
    if (auto copied = copy_if_there(ray_points_path(folder), ray_points_path(target)); !copied) return copied;
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
    for (const std::string& line : shard->lines)
      drawers.insert(drawer_of_line(Json::parse(line, nullptr, false)));
  }
  if (!header) return fail(ErrorKind::usage, "no shard is given");
  if (cells.size() != header->cells)
    return fail(ErrorKind::usage, fmt::format("{} of {} cells are there: a shard is missing or not finished",
                                              cells.size(), header->cells));
  const SweepHeader whole = make_header(header->configuration, header->cells, {});
  const Lines lines = lines_of(cells);
  const auto claim = SweepClaim::of(target);
  if (!claim) return fail(claim.error());
  if (auto takes = check_takes_sweep(target, whole, lines.axes); !takes) return fail(takes.error());
  auto staged = StagedFolder::open(target);
  if (!staged) return fail(staged.error());
  if (auto written = write_whole(cells, lines, whole, folders, staged->path()); !written)
    return fail(written.error());
  const auto page = write_sweep_page(staged->path(), report_max_mb, limit);
  if (!page) return fail(page.error());
  if (auto sealed = staged->seal({}); !sealed) return fail(sealed.error());
  if (auto there = staged->publish("report.html"); !there) return fail(there.error());
  return MergedSweep{cells.size(), *page, {drawers.begin(), drawers.end()}};
}

}  // namespace gnomon::compare
