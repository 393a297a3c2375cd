#include "studies/tune/full_grid.h"

#include <algorithm>

#include "raster/technique_traits.h"
#include "studies/tune/tuner.h"

namespace gnomon::studies {
namespace {

using compare::Setting;

// Settings of the grid that are drawn again: single times are off by more than what the first of them differ
// in.
constexpr std::size_t drawn_again = 8;

class FullGrid {
 public:
  FullGrid(Engine& engine, const Setting& base, const TuneOptions& options, const TuneProgress& progress)
      : engine_(engine), base_(base), options_(options), progress_(progress) {}

  Expected<void> draw_all(const std::vector<raster::Bias>& biases, GridCheck& check);
  /// The cheapest first.
  std::vector<GridPoint>& good() { return good_; }
  Expected<double> time_again(std::size_t family, const Attempt& attempt);

 private:
  Setting setting_of(std::size_t family, int size, const raster::Bias& bias) const;
  Expected<void> draw(std::size_t family, int size, const raster::Bias& bias, GridCheck& check);

  Engine& engine_;
  const Setting& base_;
  const TuneOptions& options_;
  const TuneProgress& progress_;
  std::vector<GridPoint> good_;
};

Setting FullGrid::setting_of(std::size_t family, int size, const raster::Bias& bias) const {
  Setting setting = base_;
  setting.raster.map = options_.families[family].map;
  setting.raster.map.size = size;
  setting.raster.map.bias = bias;
  setting.raster.runs = std::min(base_.raster.runs, 1);
  return setting;
}

Expected<void> FullGrid::draw(std::size_t family, int size, const raster::Bias& bias, GridCheck& check) {
  if (progress_) progress_(options_.families[family], size, check.grid_drawings);
  const Setting setting = setting_of(family, size, bias);
  const auto probe = engine_.probe(setting, options_.goal.measure());
  if (!probe) return fail(probe.error());
  ++check.grid_drawings;
  ++check.cells;
  Attempt attempt;
  attempt.size = size;
  attempt.bias = probe->best ? probe->bias_at_best : bias;
  attempt.bias_world = probe->best ? probe->best->constant_world : probe->bias_world;
  set_figures(probe->best ? probe->lights_at_best : probe->lights, options_.goal.measure(), attempt);
  attempt.texel_world = probe->texel_world;
  attempt.time_ms = probe->raster_ms;
  attempt.cost = options_.cost ? options_.cost(setting, *probe) : probe->raster_ms;
  if (is_good(options_.goal, attempt)) good_.push_back({family, attempt});
  return {};
}

Expected<void> FullGrid::draw_all(const std::vector<raster::Bias>& biases, GridCheck& check) {
  for (std::size_t family = 0; family < options_.families.size(); ++family)
    for (const int size : options_.sizes) {
      const raster::MapOptions& map = options_.families[family].map;
      std::vector<raster::Bias> own{map.bias};
      if (!compare::biases_follow_from_gaps(map) && raster::compares_depths(map.technique)) {
        own.clear();
        for (const raster::Bias& bias : biases) {
          own.push_back(map.bias);
          own.back().constant = bias.constant, own.back().unit = bias.unit;
        }
      }
      for (const raster::Bias& bias : own)
        if (auto drawn = draw(family, size, bias, check); !drawn) return drawn;
    }
  std::stable_sort(good_.begin(), good_.end(),
                   [](const GridPoint& a, const GridPoint& b) { return a.attempt.cost < b.attempt.cost; });
  check.good_cells = good_.size();
  return {};
}

Expected<double> FullGrid::time_again(std::size_t family, const Attempt& attempt) {
  return engine_.time_drawing(setting_of(family, attempt.size, attempt.bias));
}

// The tuner's answer and the grid's cheapest, drawn in turn: their least times, for what else the machine
// does can only add.
Expected<void> measure_in_turn(FullGrid& grid, int rounds, GridCheck& check) {
  std::vector<GridPoint>& points = grid.good();
  points.resize(std::min(points.size(), drawn_again));
  points.push_back({check.tuned.winner, *check.tuned.families[check.tuned.winner].answer});
  for (GridPoint& point : points) point.attempt.times.runs.clear();
  for (int round = 0; round < rounds; ++round)
    for (GridPoint& point : points) {
      const auto ms = grid.time_again(point.family, point.attempt);
      if (!ms) return fail(ms.error());
      point.attempt.times.runs.push_back(*ms);
    }
  for (GridPoint& point : points) {
    point.attempt.time_ms = point.attempt.times.median();
    point.attempt.cost = point.attempt.times.least();
  }
  check.tuned_cost = points.back().attempt.cost;
  return {};
}

}  // namespace

Expected<GridCheck> check_against_grid(Engine& engine, const Setting& base, const TuneOptions& options,
                                       const std::vector<raster::Bias>& biases, int rounds,
                                       const TuneProgress& progress) {
  GridCheck check;
  auto tuned = tune(engine, base, options, progress);
  if (!tuned) return fail(tuned.error());
  check.tuned = std::move(*tuned);
  check.tune_drawings = check.tuned.renders;
  FullGrid grid(engine, base, options, progress);
  if (auto drawn = grid.draw_all(biases, check); !drawn) return fail(drawn.error());
  if (check.tuned.feasible) check.tuned_cost = check.tuned.families[check.tuned.winner].answer->cost;
  if (grid.good().empty()) return check;
  if (check.tuned.feasible && !options.cost)
    if (auto measured = measure_in_turn(grid, rounds, check); !measured) return fail(measured.error());
  const auto price = [&](const GridPoint& point) {
    return options.goal.max_error ? point.attempt.cost : point.attempt.error;
  };
  check.best = *std::min_element(grid.good().begin(), grid.good().end(),
                                 [&](const GridPoint& a, const GridPoint& b) { return price(a) < price(b); });
  check.best_cost = check.best->attempt.cost;
  return check;
}

}  // namespace gnomon::studies
