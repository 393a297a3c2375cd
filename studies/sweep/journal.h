// The folder of a sweep: what was asked for, and one line per finished cell, in the order of the cells.
// Files:
//   sweep.json         the configuration; a folder takes one configuration only
//   sweep.jsonl        one result per line (result_schema.h, with `axes`), without times: the same sweep gives the
//                      same bytes, however often it was interrupted
//   sweep.csv          the same numbers and the times as a table (result_table.h)
//   sweep_times.jsonl  the times of each line of sweep.jsonl, in the same order, and once all lines are there, those of
//                      every further round of the cells (rounds.h)
// A line is appended with one write() and reaches the system before the next cell begins; what a crash leaves
// of a torn last line is cut off when the folder is opened again, and its cell is made again.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compare/result/result_table.h"
#include "scene/base/expected.h"
#include "studies/sweep/own_files.h"
#include "studies/sweep/sweep_line.h"

namespace gnomon::studies {

/// Nobody else takes up or replaces the sweep of a folder while one lives.
class SweepClaim {
 public:
  /// Where no sweep is, there is nothing to claim. ErrorKind::usage while another process is at work in the folder.
  static Expected<SweepClaim> of(const std::string& folder);

 private:
  explicit SweepClaim(OwnFile file) : file_(std::move(file)) {}
  OwnFile file_;
};

/// Whether a sweep may be put into the folder: it holds none, or the same one, and no line that is not the sweep's own.
/// Changes nothing. Errors as of Journal::open().
Expected<void> check_takes_sweep(const std::string& folder, const SweepHeader& header,
                                 const std::vector<std::string>& axes);

/// The files of a finished sweep, all but its pictures and its page, as a journal that got all these lines leaves them.
/// Lines and times, of all rounds, are sealed; `cells` as for Journal::open().
Expected<void> write_sweep(const std::string& folder, const SweepHeader& header,
                           const std::vector<std::size_t>& cells, const std::vector<std::string>& lines,
                           const std::vector<std::string>& times);

/// Lines already there, and where new ones go.
class Journal {
 public:
  /// Makes the folder, or takes up the sweep that it holds. `axes`: of every line that this shard will have,
  /// in order, as the text of their "axes" object. Errors:
  /// - ErrorKind::usage when the folder holds another configuration or another process is at work in it
  /// - bad_input for a line that is not this sweep's
  /// - cannot_write for a file that is no sweep's (own_files.h); all of it is then as it was
  /// `cells`: the index of each line's cell in the whole sweep.
  static Expected<Journal> open(const std::string& folder, const SweepHeader& header,
                                const std::vector<std::string>& axes, std::vector<std::size_t> cells);
  Journal(Journal&&) noexcept;
  Journal& operator=(Journal&&) noexcept;
  ~Journal();

  /// Cells found or appended so far.
  std::size_t size() const { return size_; }
  /// What drew the first of them (drawer_of_line); empty where there is none.
  const std::string& drawer() const { return drawer_; }
  /// Lines of times, of all rounds.
  std::size_t times_size() const { return times_size_; }
  /// The view that a cell's times are of; 0 without views.
  std::size_t view_of(std::size_t place) const { return views_[place]; }
  /// A torn or surplus line was cut off on opening.
  bool was_torn() const { return torn_; }

  /// Appends a cell, sealed. Both are objects.
  Expected<void> append(const nlohmann::ordered_json& line, const nlohmann::ordered_json& times);
  /// Appends the times of a further round, sealed, in the order of the cells; all cells are there.
  Expected<void> append_round(const nlohmann::ordered_json& times);
  /// Writes the table once more, with the times of all rounds.
  Expected<void> finish_rounds();

 private:
  Journal() = default;
  struct File;
  Expected<void> write_table();
  std::unique_ptr<File> line_file_, time_file_, table_file_;
  compare::ResultTable table_;
  std::vector<std::size_t> cells_;
  std::size_t size_ = 0, times_size_ = 0;
  std::vector<std::size_t> views_;
  std::string drawer_;
  bool torn_ = false;
};

/// The whole lines of a shard's or a finished sweep's folder. Errors are ErrorKind::bad_input.
struct SweepLines {
  SweepHeader header;
  std::vector<std::string> lines;
  std::vector<std::string> times;   ///< one for each line, of all rounds together
  std::vector<std::string> rounds;  ///< as they stand in the file
};
Expected<SweepLines> read_sweep(const std::string& folder);

}  // namespace gnomon::studies
