#include "app/sweep/make_cells.h"

#include <fmt/core.h>

#include <deque>
#include <future>

#include "app/process/interrupt.h"
#include "compare/result/output_parts.h"
#include "scene/base/threads.h"
#include "scene/base/timing.h"
#include "studies/sweep/cell_files.h"

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
  std::string line, times;
  CellPictureWriter::Job pictures;
  std::future<Expected<void>> written;
};

/// The lights that `compare` would keep for the cell, and the film of these.
Expected<void> take_lights(Workshop& shop, const SettingOptions& options) {
  std::vector<Light> lights = shop.keeper.kept(named_lights(options.light), options.poses);
  if (lights == shop.given.lights) return {};
  shop.given.lights = std::move(lights);
  if (!shop.command.metric.is_filmed()) return {};
  Console quiet(true);  // its notes were there before the first cell
  const auto film = resolve_film(shop.command.metric.film, shop.loaded.paths, shop.given, quiet);
  if (!film) return fail(film.error());
  shop.engine.film_with(*film);
  return {};
}

Expected<MadeCell> make_cell(Workshop& shop, std::size_t index) {
  const Stopwatch watch;
  const std::size_t cell = shop.plan.cells[index];
  auto options = shop.command.options.parse_cell(shop.plan.grid, cell);
  if (!options) return fail(options.error());
  set_runs(shop.command, options->options);
  options->options.raytrace.seed = shop.command.seed;
  options->options.raster.shadow_cost = true;
  if (const auto taken = take_lights(shop, *options); !taken) return fail(taken.error());
  auto setting = resolve_setting(*options, shop.given, *shop.loaded.world);
  if (!setting) return fail(setting.error());
  const auto compared = shop.engine.compare(*setting, compare::Detail::numbers);
  if (!compared) return fail(compared.error());
  compare::Comparison& comparison = **compared;
  comparison.command = compare_command(shop.command, shop.plan, cell);
  comparison.seed = shop.command.seed;
  comparison.machine = shop.machine;
  MadeCell made;
  const auto idle = json_names(shop.command.options.idle_axes(shop.plan.grid, cell));
  made.line = compare::result_line(comparison, axis_values(shop.plan.grid, cell), idle);
  made.times = compare::times_line(comparison, cell, shop.engine.last_was_derived(), watch.elapsed_ms());
  if (compare::has_thumbnail(cell, shop.plan.grid.cells()))
    made.pictures = shop.pictures.pictures(cell, comparison);
  return made;
}

/// Cells on their way into the journal, in order: while some cells' pictures are written the next are made.
class CellQueue {
 public:
  explicit CellQueue(compare::Journal& journal) : journal_(journal) {}

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
      --writing_;
      if (auto written = cell.written.get(); !written) return written;
    }
    const OutputGuard whole_lines;
    return journal_.append(cell.line, cell.times);
  }

  compare::Journal& journal_;
  std::deque<MadeCell> cells_;
  std::size_t writing_ = 0;
};

}  // namespace

Expected<void> make_cells(Workshop& shop, compare::Journal& journal) {
  const Stopwatch watch;
  const std::size_t all = shop.plan.cells.size(), before = journal.lines().size();
  CellQueue queue(journal);
  for (std::size_t i = before; i < all; ++i) {
    shop.console.progress(
        fmt::format("cell {} of {}{}", i + 1, all, time_left(watch.elapsed_ms(), i - before, all - i)),
        double(i) / double(all));
    auto made = make_cell(shop, i);
    if (!made) {
      if (auto finished = queue.finish(0); !finished) return finished;
      return fail(made.error());
    }
    if (auto pushed = queue.push(std::move(*made)); !pushed) return pushed;
  }
  return queue.finish(0);
}

}  // namespace gnomon::app
