#include "studies/sweep/journal.h"

#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>

#include "compare/result/output_parts.h"
#include "scene/base/interrupted.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/rounds.h"

namespace gnomon::studies {
namespace {

using Json = nlohmann::ordered_json;

tl::unexpected<Error> bad_line(const std::string& path, std::size_t line, std::string reason) {
  return fail(Error{ErrorKind::bad_input, std::move(reason), path, static_cast<int>(line)});
}

// Lines with their breaks; what follows the last break is dropped.
std::vector<std::string> whole_lines(const std::string& bytes) {
  std::vector<std::string> lines;
  for (std::size_t start = 0; start < bytes.size();) {
    const std::size_t end = bytes.find('\n', start);
    if (end == std::string::npos) break;
    lines.push_back(bytes.substr(start, end + 1 - start));
    start = end + 1;
  }
  return lines;
}

std::size_t size_of_lines(const std::vector<std::string>& lines) {
  std::size_t count = 0;
  for (const std::string& line : lines) count += line.size();
  return count;
}

}  // namespace

// A file that grows by whole lines. A line that could not be written whole is taken back.
struct Journal::File {
  explicit File(OwnFile file) : own(std::move(file)), path(own.path()), descriptor(own.descriptor()) {}
  OwnFile own;
  const std::string& path;
  int descriptor;
  std::size_t size = 0;

  static Expected<std::unique_ptr<File>> open(const std::string& folder, std::string_view name) {
    auto own = OwnFile::open(folder, name, true);
    if (!own) return fail(own.error());
    return std::make_unique<File>(std::move(*own));
  }
  Expected<void> cut(std::size_t length) {
    size = length;
    if (uninterrupted([&] { return ::ftruncate(descriptor, static_cast<off_t>(length)); }) != 0)
      return failed_call(ErrorKind::cannot_write, path, "cannot cut", errno);
    return {};
  }
  Expected<void> append(const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t count =
          ::pwrite(descriptor, text.data() + done, text.size() - done, static_cast<off_t>(size + done));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        const int error_number = count < 0 ? errno : ENOSPC;
        if (auto cut_back = cut(size); !cut_back) return cut_back;
        return failed_call(ErrorKind::cannot_write, path, "cannot write", error_number);
      }
      done += static_cast<std::size_t>(count);
    }
    size += text.size();
    return {};
  }
};

namespace {

// Names the options in which two configurations differ.
std::string differences(const std::string& a, const std::string& b) {
  const Json x = Json::parse(a).flatten(), y = Json::parse(b).flatten();
  std::vector<std::string> keys;
  for (const auto& [key, value] : x.items())
    if (!y.contains(key) || y[key] != value) keys.push_back(key);
  for (const auto& [key, value] : y.items())
    if (!x.contains(key)) keys.push_back(key);
  std::string text;
  for (std::size_t i = 0; i < keys.size() && i < 3; ++i) text += (i == 0 ? "" : ", ") + keys[i].substr(1);
  return keys.size() > 3 ? text + ", …" : text;
}

/// Where a header is; true: it is this sweep's. Error (cannot_write): it is no sweep's.
Expected<bool> has_header(const std::string& folder, const SweepHeader& header) {
  const auto cells = cells_of_sweep(folder);
  if (!cells) return fail(cells.error());
  if (!*cells) return false;
  const auto there = read_header(folder, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (there->hash != header.hash)
    return fail(ErrorKind::usage,
                fmt::format("{} holds another sweep (it differs in {}); give another folder, or --restart",
                            folder, differences(there->configuration, header.configuration)));
  if (there->shard.part != header.shard.part || there->shard.of != header.shard.of)
    return fail(ErrorKind::usage, fmt::format("{} holds shard {}/{} of this sweep; give another folder",
                                              folder, there->shard.part, there->shard.of));
  return true;
}

/// Whether the folder holds this sweep (true) or none, and else nothing in the place of what is one's.
Expected<bool> check_folder(const std::string& folder, const SweepHeader& header) {
  const auto same = has_header(folder, header);
  if (!same) return same;
  const auto own = check_own_files(folder, *same);
  return own ? same : Expected<bool>(fail(own.error()));
}

tl::unexpected<Error> is_claimed(const std::string& folder) {
  return fail(ErrorKind::usage, folder + ": another process is at work in this folder");
}

constexpr std::string_view edited =
    "this line is not as the sweep wrote it: its checksum does not fit (--restart makes the sweep anew)";

Json parsed(std::string_view line) {
  return Json::parse(line, nullptr, false);
}

// How many of the lines are this sweep's; an error for one that is not, unless it is a torn last one.
Expected<std::size_t> count_good(const std::string& path, const std::vector<std::string>& lines,
                                 const std::vector<std::string>& axes) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool belongs = i < axes.size() && axes_of_line(parsed(lines[i])) == axes[i];
    if (belongs && is_sealed(lines[i])) continue;
    const bool torn = begins_as_own("sweep.jsonl", lines[i]) && !parsed(lines[i]).is_object();
    if (i + 1 == lines.size() && torn) return i;
    return bad_line(path, i + 1,
                    belongs ? std::string(edited) : "not the line of this sweep that belongs here");
  }
  return lines.size();
}

/// Holds the first `keep` lines against their checksums.
Expected<void> check_seals(const std::string& path, const std::vector<std::string>& lines, std::size_t keep) {
  std::vector<char> whole(keep, 0);
  parallel_for(keep, [&](std::size_t i) { whole[i] = static_cast<char>(is_sealed(lines[i])); });
  const auto bad = std::find(whole.begin(), whole.end(), 0);
  if (bad == whole.end()) return {};
  return bad_line(path, static_cast<std::size_t>(bad - whole.begin()) + 1, std::string(edited));
}

}  // namespace

namespace {

/// The lines and times that are there, without what is torn or surplus.
struct GoodLines {
  std::vector<std::string> lines, times;
  bool torn = false;
};

/// Whether all that will be cut off, the whole lines from `keep` on and what follows the last, begins as a sweep's lines do.
Expected<void> check_rest(const OwnFile& file, std::string_view name, const std::string& text,
                          const std::vector<std::string>& lines, std::size_t keep) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= lines.size(); ++i) {
    if (i >= keep && !begins_as_own(name, std::string_view(text).substr(begin)))
      return bad_line(file.path(), i + 1, "no line of a sweep, and no beginning of one");
    if (i < lines.size()) begin += lines[i].size();
  }
  return {};
}

Expected<GoodLines> read_lines(const OwnFile& line_file, const OwnFile& time_file,
                               const std::vector<std::string>& axes) {
  const auto bytes = line_file.text(), bytes_of_times = time_file.text();
  if (!bytes) return fail(bytes.error());
  if (!bytes_of_times) return fail(bytes_of_times.error());
  GoodLines found{whole_lines(*bytes), whole_lines(*bytes_of_times), false};
  const auto good = count_good(line_file.path(), found.lines, axes);
  if (!good) return fail(good.error());
  // Times are written first: a line without times cannot be, but a surplus of times can. Of all cells it is further rounds.
  const std::size_t keep = std::min(*good, found.times.size());
  const std::size_t keep_times = keep == axes.size() && keep > 0 ? found.times.size() : keep;
  if (auto fine = check_seals(time_file.path(), found.times, keep_times); !fine) return fail(fine.error());
  if (auto fine = check_rest(line_file, "sweep.jsonl", *bytes, found.lines, keep); !fine)
    return fail(fine.error());
  if (auto fine = check_rest(time_file, "sweep_times.jsonl", *bytes_of_times, found.times, keep_times); !fine)
    return fail(fine.error());
  found.lines.resize(keep);
  found.times.resize(keep_times);
  found.torn = size_of_lines(found.lines) != bytes->size();
  return found;
}

/// `cells`: of every line that there will be; `rounds`: the lines of times.
Expected<void> fill_table(const std::string& folder, compare::ResultTable& table,
                          std::span<const std::size_t> cells, const std::vector<std::string>& lines,
                          const std::vector<std::string>& rounds) {
  const auto joined = joined_rounds(rounds, cells.size());
  if (!joined) return bad_line(path_in(folder, "sweep_times.jsonl"), 0, joined.error().reason);
  const std::vector<std::string>& times = *joined;
  for (std::size_t i = 0; i < lines.size(); ++i) try {
      table.add(cells[i], parsed(lines[i]), parsed(times[i]));
    } catch (const Json::exception&) {
      return bad_line(
          path_in(folder, "sweep.jsonl"), i + 1,
          "a line of another version of the program, which lacks what its table needs (--restart makes "
          "the sweep anew)");
    }
  return {};
}

/// 0 in what sweeps without views wrote.
std::size_t view_of_times(const Json& times) {
  return times.is_object() ? times.value("view", std::size_t{0}) : 0;
}

/// Whether lines of times beyond the first round are another one, which begins with the first cell; else the last is of a
/// cell whose line is not there yet.
bool has_further_round(const std::vector<std::string>& times, std::size_t cells) {
  if (cells == 0 || times.size() <= cells) return false;
  const Json first = parsed(times.front()), next = parsed(times[cells]);
  return first.is_object() && next.is_object() && first.value("cell", Json()) == next.value("cell", Json());
}

std::string all_of_lines(const std::vector<std::string>& lines) {
  std::string text;
  text.reserve(size_of_lines(lines));
  for (const std::string& line : lines) text += line;
  return text;
}

}  // namespace

Expected<SweepClaim> SweepClaim::of(const std::string& folder) {
  auto file = OwnFile::open(folder, "sweep.jsonl", false);
  if (!file) return fail(file.error());
  if (file->is_open() && ::flock(file->descriptor(), LOCK_EX | LOCK_NB) != 0) return is_claimed(folder);
  return SweepClaim(std::move(*file));
}

Expected<void> check_takes_sweep(const std::string& folder, const SweepHeader& header,
                                 const std::vector<std::string>& axes) {
  if (const auto same = check_folder(folder, header); !same) return fail(same.error());
  const auto lines = OwnFile::open(folder, "sweep.jsonl", false),
             times = OwnFile::open(folder, "sweep_times.jsonl", false);
  if (!lines) return fail(lines.error());
  if (!times) return fail(times.error());
  const auto found = read_lines(*lines, *times, axes);
  return found ? Expected<void>{} : fail(found.error());
}

Expected<void> write_sweep(const std::string& folder, const SweepHeader& header,
                           const std::vector<std::size_t>& cells, const std::vector<std::string>& lines,
                           const std::vector<std::string>& times) {
  compare::ResultTable table;
  if (auto filled = fill_table(folder, table, cells, lines, times); !filled) return filled;
  for (const auto& [name, text] :
       {std::pair("sweep.json", header_json(header)), std::pair("sweep.jsonl", all_of_lines(lines)),
        std::pair("sweep_times.jsonl", all_of_lines(times)), std::pair("sweep.csv", table.text())})
    if (auto written = write_file(path_in(folder, name), text); !written) return written;
  return {};
}

Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

Expected<Journal> Journal::open(const std::string& folder, const SweepHeader& header,
                                const std::vector<std::string>& axes, std::vector<std::size_t> cells) {
  const TimedStage stage("records");
  if (auto made = make_output_folder(folder); !made) return fail(made.error());
  // Before anything is made in the folder, and again of what is then open.
  if (const auto own = check_folder(folder, header); !own) return fail(own.error());
  Journal journal;
  auto lines = File::open(folder, "sweep.jsonl");
  if (!lines) return fail(lines.error());
  if (::flock((*lines)->descriptor, LOCK_EX | LOCK_NB) != 0) return is_claimed(folder);
  const auto same = check_folder(folder, header);
  if (!same) return fail(same.error());
  if (!*same)
    if (auto written = write_file(path_in(folder, "sweep.json"), header_json(header)); !written)
      return fail(written.error());
  auto times = File::open(folder, "sweep_times.jsonl");
  if (!times) return fail(times.error());
  auto table = File::open(folder, "sweep.csv");
  if (!table) return fail(table.error());
  if (const auto text = (*table)->own.text(); !text) return fail(text.error());

  auto found = read_lines((*lines)->own, (*times)->own, axes);
  if (!found) return fail(found.error());
  journal.size_ = found->lines.size();
  if (journal.size_ > 0) journal.drawer_ = drawer_of_line(parsed(found->lines.front()));
  journal.torn_ = found->torn;
  journal.times_size_ = found->times.size();
  for (std::size_t i = 0; i < journal.size_; ++i)
    journal.views_.push_back(view_of_times(parsed(found->times[i])));
  if (auto cut = (*lines)->cut(size_of_lines(found->lines)); !cut) return fail(cut.error());
  if (auto cut = (*times)->cut(size_of_lines(found->times)); !cut) return fail(cut.error());
  journal.line_file_ = std::move(*lines);
  journal.time_file_ = std::move(*times);
  journal.table_file_ = std::move(*table);
  journal.cells_ = std::move(cells);
  const std::span<const std::size_t> all(journal.cells_);
  if (auto gone = remove_strays(folder, all.subspan(journal.size_)); !gone) return fail(gone.error());
  if (auto filled = fill_table(folder, journal.table_, all, found->lines, found->times); !filled)
    return fail(filled.error());
  if (auto written = journal.write_table(); !written) return fail(written.error());
  return journal;
}

// The table follows from the lines, so it is simply made again.
Expected<void> Journal::write_table() {
  if (auto cut = table_file_->cut(0); !cut) return cut;
  return table_file_->append(table_.text());
}

Expected<void> Journal::append(const compare::Json& line, const compare::Json& times) {
  if (auto written = time_file_->append(sealed(compare::on_one_line(times))); !written) return written;
  if (auto written = line_file_->append(sealed(compare::on_one_line(line))); !written) return written;
  if (size_ == 0) drawer_ = drawer_of_line(line);
  views_.push_back(view_of_times(times));
  ++times_size_;
  const std::string rows = table_.add(cells_[size_++], line, times);
  return rows.empty() ? write_table() : table_file_->append(rows);
}

Expected<void> Journal::append_round(const compare::Json& times) {
  if (auto written = time_file_->append(sealed(compare::on_one_line(times))); !written) return written;
  ++times_size_;
  return {};
}

Expected<void> Journal::finish_rounds() {
  const TimedStage stage("records");
  const auto lines = line_file_->own.text(), times = time_file_->own.text();
  if (!lines) return fail(lines.error());
  if (!times) return fail(times.error());
  table_ = {};
  if (auto filled = fill_table(line_file_->path, table_, cells_, whole_lines(*lines), whole_lines(*times));
      !filled)
    return filled;
  return write_table();
}

Expected<SweepLines> read_sweep(const std::string& folder) {
  SweepLines sweep;
  auto header = read_header(folder);
  if (!header) return fail(header.error());
  sweep.header = std::move(*header);
  const auto lines = read_file(path_in(folder, "sweep.jsonl")),
             rounds = read_file(path_in(folder, "sweep_times.jsonl"));
  if (!lines) return fail(lines.error());
  if (!rounds) return fail(rounds.error());
  sweep.lines = whole_lines(*lines), sweep.rounds = whole_lines(*rounds);
  if (auto fine = check_seals(path_in(folder, "sweep.jsonl"), sweep.lines, sweep.lines.size()); !fine)
    return fail(fine.error());
  if (sweep.rounds.size() < sweep.lines.size())
    return bad_line(path_in(folder, "sweep_times.jsonl"), sweep.rounds.size() + 1, "a line is missing");
  if (!has_further_round(sweep.rounds, sweep.lines.size())) sweep.rounds.resize(sweep.lines.size());
  if (auto fine = check_seals(path_in(folder, "sweep_times.jsonl"), sweep.rounds, sweep.rounds.size()); !fine)
    return fail(fine.error());
  auto times = joined_rounds(sweep.rounds, sweep.lines.size());
  if (!times) return bad_line(path_in(folder, "sweep_times.jsonl"), 0, times.error().reason);
  sweep.times = std::move(*times);
  return sweep;
}

}  // namespace gnomon::studies
