#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>

#include <cerrno>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "scene/base/interrupted.h"
#include "scene/files/folder.h"
#include "scene/files/path_status.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/journal.h"
#include "studies/sweep/own_files.h"
#include "studies/sweep/page.h"

namespace gnomon::studies {
namespace {

using Json = nlohmann::ordered_json;

struct Cell {
  std::string line, folder;
  std::vector<std::string> rounds;  ///< of its times
};
using Cells = std::map<std::size_t, Cell>;

Expected<void> add_shard(const std::string& folder, const SweepLines& shard, Cells& cells) {
  const auto summaries = summarise(shard);
  if (!summaries) return fail(summaries.error());
  for (std::size_t i = 0; i < shard.lines.size(); ++i) {
    const std::size_t cell = (*summaries)[i].cell;
    std::vector<std::string> rounds;
    for (std::size_t k = i; k < shard.rounds.size(); k += shard.lines.size())
      rounds.push_back(shard.rounds[k]);
    if (!cells.empty() && cells.begin()->second.rounds.size() != rounds.size())
      return fail(ErrorKind::usage,
                  fmt::format("{}: cell {} was timed more or less often than others: a shard is not finished",
                              folder, cell));
    if (!cells.emplace(cell, Cell{shard.lines[i], folder, std::move(rounds)}).second)
      return fail(ErrorKind::usage, fmt::format("{}: cell {} is in another shard too", folder, cell));
  }
  return {};
}

/// Reads a plain file of a shard through no link, which somebody else may have put there to have a file of the user's copied.
/// None: it is not there, as not every cell has pictures. `name` is below the shard. Errors are ErrorKind::bad_input.
Expected<std::optional<std::string>> read_of_shard(const std::string& shard, const std::string& name) {
  const auto named = [&](Error error) {
    error.kind = ErrorKind::bad_input;
    return fail(std::move(error));
  };
  auto folder = Folder::at(shard);
  if (!folder) return named(folder.error());
  if (const std::string around = folder_part(name); !around.empty()) {
    const auto there = folder->find(around);
    if (!there) return named(there.error());
    if (!*there) return std::optional<std::string>();
    auto below = folder->below(around);
    if (!below) return named(below.error());
    *folder = std::move(*below);
  }
  const std::string last = last_part(name), path = shard + "/" + name;
  const auto found = folder->find(last);
  if (!found) return named(found.error());
  if (!*found) return std::optional<std::string>();
  const Descriptor file(uninterrupted([&] {
    return ::openat(folder->descriptor(), last.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  }));
  if (S_ISLNK((*found)->st_mode))
    return fail(Error{ErrorKind::bad_input, "is a link, and a shard's files are its own", path});
  if (file.number() < 0) return failed_call(ErrorKind::bad_input, path, "cannot be opened", errno);
  if (!S_ISREG((*found)->st_mode)) return fail(Error{ErrorKind::bad_input, "is no plain file", path});
  auto text = text_of_open(file.number(), path, ErrorKind::bad_input);
  return text ? Expected<std::optional<std::string>>(std::move(*text)) : fail(text.error());
}

/// `name`: in the shard as in the whole.
Expected<void> copy_if_there(const std::string& shard, const std::string& name, const std::string& target) {
  const auto bytes = read_of_shard(shard, name);
  if (!bytes) return fail(bytes.error());
  return *bytes ? write_file(target + "/" + name, **bytes) : Expected<void>{};
}

/// The ray-traced pictures, whose names tell them apart.
Expected<void> copy_truths(const std::string& folder, const std::string& target) {
  const auto names = truths_in(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names)
    if (auto copied = copy_if_there(folder, "cells/" + name, target); !copied) return copied;
  return {};
}

Expected<void> copy_pictures(const Cell& cell, std::size_t index, const std::string& target) {
  const std::string name = cell_name(index);
  for (const std::string& picture : {"thumbnails/" + name + ".png", "cells/" + name + ".png"})
    if (auto copied = copy_if_there(cell.folder, picture, target); !copied) return copied;
  const std::string file = "cells/" + name + ".js";
  const auto data = read_of_shard(cell.folder, file);
  if (!data) return fail(data.error());
  if (!*data) return {};
  if (!is_cell_data(index, **data)) return fail(not_cell_data(cell.folder + "/" + file));
  return write_file(target + "/" + file, **data);
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
  }
  for (std::size_t round = 0; !cells.empty() && round < cells.begin()->second.rounds.size(); ++round)
    for (const auto& [index, cell] : cells) all.times.push_back(cell.rounds[round]);
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
    if (auto copied = copy_if_there(folder, "ray_tracer.json", target); !copied) return copied;
  }
  return {};
}

}  // namespace

Expected<MergedSweep> merge_sweeps(const std::vector<std::string>& folders, const std::string& target,
                                   double report_max_mb, const std::optional<compare::Threshold>& limit) {
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
      drawers.insert(drawer_of_line(compare::Json::parse(line, nullptr, false)));
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

}  // namespace gnomon::studies
