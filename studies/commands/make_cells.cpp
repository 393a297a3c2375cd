#include "studies/commands/make_cells.h"

#include <fmt/core.h>

#include <deque>
#include <future>
#include <nlohmann/json.hpp>

#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "compare/result/output_parts.h"
#include "scene/base/stages.h"
#include "scene/base/threads.h"
#include "scene/base/timing.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/rounds.h"

namespace gnomon::app {
namespace {

std::string time_left(double ms, std::size_t done, std::size_t left) {
  if (done == 0) return "";
  const double seconds = ms / 1000.0 / double(done) * double(left);
  if (seconds < 90.0) return fmt::format(", {:.0f} s left", seconds);
  return seconds < 5400.0 ? fmt::format(", {:.0f} min left", seconds / 60.0)
                          : fmt::format(", {:.1f} h left", seconds / 3600.0);
}

/// A cell that is made but for its pictures, which another thread encodes and writes. Its line goes into the
/// journal once they are there.
struct MadeCell {
  nlohmann::ordered_json line, times;
  CellPictureWriter::Job pictures;
  std::future<Expected<void>> written;
};

}  // namespace

Expected<void> look_from_views(const SweepCommand& command, const LoadedScene& loaded, const Scene& given,
                               studies::Engine& engine, Console& console) {
  auto views =
      resolve_views(command.views, command.asked.film, command.asked.is_filmed(), loaded, given, console);
  if (!views) return fail(views.error());
  if (!views->empty()) engine.look_from(std::move(*views), view_measure(command));
  return {};
}

namespace {

/// The lights that `compare` would keep for the cell, and the film of these.
Expected<void> apply_lights(SweepRun& run, const SettingOptions& options) {
  std::vector<Light> lights = run.selection.kept(named_lights(options.light), options.poses);
  if (lights == run.given.lights) return {};
  run.given.lights = std::move(lights);
  Console quiet(true);  // its notes were there before the first cell
  if (const auto looked = look_from_views(run.command, run.loaded, run.given, run.engine, quiet); !looked)
    return looked;
  if (!run.command.asked.is_filmed()) return {};
  const StageSource source = stage_source(run.command);
  const auto film = resolve_film(run.command.asked.film, run.loaded.paths, run.given, quiet, &source);
  if (!film) return fail(film.error());
  run.engine.film_with(*film);
  return {};
}

/// The setting of a cell, each of whose passes is run once a round.
Expected<compare::Setting> setting_of(SweepRun& run, std::size_t cell) {
  const TimedStage reading("settings");
  auto options = run.command.options.parse_cell(run.plan.grid, cell);
  if (!options) return fail(options.error());
  set_runs(run.command, options->options);
  options->options.raster.runs = std::min(options->options.raster.runs, 1);
  options->options.raytrace.seed = run.command.seed;
  options->options.raster.shadow_cost = true;
  if (const auto taken = apply_lights(run, *options); !taken) return fail(taken.error());
  return resolve_setting(*options, run.given, *run.loaded.world);
}

Expected<MadeCell> make_cell(SweepRun& run, std::size_t index) {
  const Stopwatch watch;
  const std::size_t cell = run.plan.cells[index];
  const auto setting = setting_of(run, cell);
  if (!setting) return fail(setting.error());
  const auto compared = run.engine.compare(*setting, studies::Detail::numbers);
  if (!compared) return fail(compared.error());
  compare::Comparison& comparison = **compared;
  const TimedStage stage("records");
  comparison.command = compare_command(run.command, run.plan, cell);
  comparison.seed = run.command.seed;
  comparison.machine = run.machine;
  MadeCell made;
  const auto without_effect = json_names(run.command.options.axes_without_effect(run.plan.grid, cell));
  const int once = std::exchange(comparison.raster.options.runs, rounds_of(run.command));
  made.line = compare::line_json(comparison, axis_values(run.plan.grid, cell), without_effect,
                                 run.command.full_records);
  comparison.raster.options.runs = once;
  made.times = compare::cell_times_json(
      comparison, cell, {run.engine.last_was_derived(), watch.elapsed_ms(), run.engine.shown_view()});
  if (run.pictured.take(cell, comparison, run.engine.last_was_derived()))
    made.pictures = run.pictures.pictures(cell, comparison);
  return made;
}

/// Cells on their way into the journal, in order: while some cells' pictures are written the next are made.
class CellQueue {
 public:
  explicit CellQueue(studies::Journal& journal) : journal_(journal) {}

  Expected<void> push(MadeCell cell) {
    if (cell.pictures) {
      cell.written = in_background(std::move(cell.pictures));
      ++writing_;
    }
    cells_.push_back(std::move(cell));
    return finish(most_writing);
  }

  /// Until at most so many cells' pictures are still being written, and the first of the queue's are.
  Expected<void> finish(std::size_t writing) {
    while (!cells_.empty() && (writing_ > writing || !cells_.front().written.valid()))
      if (auto finished = finish_first(); !finished) return finished;
    return {};
  }

 private:
  static constexpr std::size_t most_writing = 4;  // small pictures and codes of one light: some MB each

  Expected<void> finish_first() {
    MadeCell cell = std::move(cells_.front());
    cells_.pop_front();
    if (cell.written.valid()) {
      const TimedStage stage("cell pictures");
      --writing_;
      if (auto written = cell.written.get(); !written) return written;
    }
    const TimedStage stage("records");
    const OutputGuard whole_lines;
    return journal_.append(cell.line, cell.times);
  }

  studies::Journal& journal_;
  std::deque<MadeCell> cells_;
  std::size_t writing_ = 0;
};

/// All cells once more, for their times alone: the machine's slow moments then fall on none of them alone.
Expected<void> time_round(SweepRun& run, int round, studies::Journal& journal) {
  const std::size_t all = run.plan.cells.size(), before = static_cast<std::size_t>(round) * all;
  run.engine.begin_round();
  for (std::size_t i = 0; i < all; ++i) {
    if (journal.times_size() > before + i) continue;
    run.console.progress(fmt::format("times, round {}, cell {} of {}", round + 1, i + 1, all),
                         double(i) / double(all));
    const std::size_t cell = run.plan.cells[i];
    const auto setting = setting_of(run, cell);
    if (!setting) return fail(setting.error());
    const auto timed = run.engine.time_again(*setting, journal.view_of(i));
    if (!timed) return fail(timed.error());
    const TimedStage stage("records");
    const OutputGuard whole_lines;
    run.machine.load = load_of_last_minute();
    if (auto added = journal.append_round(studies::round_json(**timed, cell, run.machine)); !added)
      return added;
  }
  return {};
}

}  // namespace

bool has_all_rounds(const SweepCommand& command, const studies::Journal& journal, std::size_t cells) {
  const auto rounds = static_cast<std::size_t>(std::max(1, rounds_of(command)));
  return journal.size() == cells && journal.times_size() == rounds * cells;
}

Expected<void> time_rounds(SweepRun& run, studies::Journal& journal) {
  for (int round = 1; round < rounds_of(run.command); ++round)
    if (auto timed = time_round(run, round, journal); !timed) return timed;
  return journal.finish_rounds();
}

Expected<void> make_cells(SweepRun& run, studies::Journal& journal) {
  const Stopwatch watch;
  const std::size_t all = run.plan.cells.size(), before = journal.size();
  CellQueue queue(journal);
  for (std::size_t i = before; i < all; ++i) {
    run.console.progress(
        fmt::format("cell {} of {}{}", i + 1, all, time_left(watch.elapsed_ms(), i - before, all - i)),
        double(i) / double(all));
    auto made = make_cell(run, i);
    if (!made) {
      if (auto finished = queue.finish(0); !finished) return finished;
      return fail(made.error());
    }
    if (auto pushed = queue.push(std::move(*made)); !pushed) return pushed;
  }
  return queue.finish(0);
}

}  // namespace gnomon::app
