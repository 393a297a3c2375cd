#include "compare/measure/sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/ladder/ladder.h"
#include "compare/measure/run_all.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/ssim.h"
#include "compare/result/shadow_cost.h"
#include "compare/truth/cascades.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"

namespace gnomon::compare {
namespace {

constexpr int perception_margin = 64;  // rows; more than the filters of FLIP and SSIM reach

/// Rows wanted and as many around them as there are.
PictureRows widened(const PictureRows& rows, int by, int height) {
  const int first = std::max(0, rows.first - by), end = std::min(height, rows.end() + by);
  return {first, end - first};
}

}  // namespace

void Perception::add(const NearLight& light, int first_row, const PictureRows& rows, int height,
                     MetricMaps& maps) {
  const PictureRows wide = widened(rows, perception_margin, height);
  const PictureRows near{wide.first - first_row, wide.count}, inner{rows.first - wide.first, rows.count};
  const Image<float> truth = visibility_picture(light.truth, light.labels, near);
  const Image<float> drawn = visibility_picture(light.drawn, light.labels, near);
  maps.flip_map = cut_rows(flip_error(truth, drawn), inner);
  for (int y = 0; y < rows.count; ++y) {
    double row = 0.0;
    for (int x = 0; x < maps.flip_map.size.width; ++x) row += static_cast<double>(maps.flip_map.at(x, y));
    flip_sum_ += row;
  }
  flips_ += maps.flip_map.data.size();
  maps.ssim_map = cut_rows(ssim_by_pixel(ssim_map(truth, drawn), truth.size), inner);
  constexpr int middle = ssim_window / 2;
  for (int y = 0; y < rows.count; ++y) {
    const int row = rows.first + y;
    if (row < middle || row >= height - middle) continue;
    for (int x = middle; x < maps.ssim_map.size.width - middle; ++x)
      ssim_sum_ += static_cast<double>(maps.ssim_map.at(x, y)), ++ssims_;
  }
  const int first = rows.first - first_row;
  flip_compared_.add(maps.flip_map, light.labels, first),
      ssim_compared_.add(maps.ssim_map, light.labels, first);
}

void Perception::write_to(ErrorStats& out) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  out.flip = flips_ == 0 ? 0.0 : flip_sum_ / static_cast<double>(flips_);
  out.ssim = ssims_ == 0 ? none : ssim_sum_ / static_cast<double>(ssims_);
  out.flip_compared = flip_compared_.mean(), out.ssim_compared = ssim_compared_.mean();
}

Expected<MetricMaps> LightSums::add_neighbours(const LadderInput& near, const NearLight& light,
                                               const PictureRows& rows) {
  MetricMaps maps;
  if (rows.count <= 0) return maps;
  const TimedStage stage("metrics");
  const int first_row = near.place.first_row;
  const PictureRows here{rows.first - first_row, rows.count};
  const EdgeInput edges{near.drawn,   near.record(), near.traced.receiver, light.truth, light.climbed,
                        near.world(), first_row};
  add_edges(edges, here, edges_);
  if (const auto seams = count_seams(near, light.labels, here)) {
    SeamCount& sum = seams_ ? *seams_ : seams_.emplace();
    sum.at_border += seams->at_border, sum.changed += seams->changed;
  }
  if (options_.perceptual) {
    maps.edge_map = edge_displacement_rows(edges, here);
    perception_.add(light, first_row, rows, picture_.height, maps);
  }
  if (options_.map != nullptr) return maps;
  TheoryValues values = theory_values(near, light.labels, here, picture_.height);
  std::vector<Step> steps;
  for (std::size_t k = 0; k < values.size(); ++k)
    steps.emplace_back([this, k, &values] {
      std::erase_if(values[k], [](double v) { return !std::isfinite(v); });
      return theory_[k].append(options_.spill, std::move(values[k]));
    });
  if (const auto added = run_all(steps); !added) return fail(added.error());
  if (rows.end() == picture_.height)
    if (const auto done = finish_theory(); !done) return fail(done.error());
  return maps;
}

/// Finishes as soon as all is there, so that these lists and those of gaps are not in memory at one time.
Expected<void> LightSums::finish_theory() {
  const auto most = std::max_element(theory_.begin(), theory_.end(),
                                     [](const auto& a, const auto& b) { return a.count() < b.count(); });
  const double bytes = 8.0 * static_cast<double>(most->count());
  std::vector<Step> steps;
  for (std::size_t k = 0; k < theory_.size(); ++k)
    steps.emplace_back([this, k]() -> Expected<void> {
      auto values = theory_[k].take();
      if (!values) return fail(values.error());
      distribution_of(map_.theory, k) = distribution(*values);
      return {};
    });
  return run_all(steps, steps_together(bytes));
}

Expected<Image<float>> LightSums::add_pixels(const LadderInput& in, const Climb& climb,
                                             const Image<Label>& labels_climbed) {
  const TimedStage stage("metrics");
  const Image<Label>& labels = climb.labels;
  if (!begun_) {
    if (options_.by_cascade) cascades_ = sums_of_cascades(in.drawn, in.record());
    soft_ = !in.truth().visibility.data.empty();
    has_curve_ = why_no_curve(in.drawn, in.record()).empty();
    has_kinds_ = has_curve_ && options_.perceptual && kinds_apply(in.drawn, in.record());
    begun_ = true;
  }
  sums_.add(climb.rungs, labels);
  for (CascadeSums& cascade : cascades_) cascade.add(in.record(), climb.rungs, labels);
  if (soft_) {
    climbed_compared_ += count_pixels(labels_climbed).compared;
    standard_errors_.add(in.truth(), labels);
    penumbra_.add(in, climb.rungs.front(), labels_climbed);
  }
  Image<float> detached = detachment_map(in.tracer, in.light(), in.traced.receiver, labels, climb.rungs);
  for (const float distance : detached.data)
    if (!std::isnan(distance)) detachment_.add(double{distance});
  std::apply([&](auto&... measure) { (measure.add(in, climb), ...); }, measures_);
  if (options_.map == nullptr) {
    const TerminatorCount here = count_terminator(in, labels);
    map_.terminator.dark += here.dark, map_.terminator.unlit += here.unlit;
  }
  if (options_.perceptual) {
    const std::size_t first = in.traced.receiver.index(0, in.place.first_row);
    add_ray_work(in.tracer, in.light(), in.traced.receiver, labels, first, picture_.pixels(), ray_work_);
    if (soft_)
      weighted_.add(in.tracer, in.light(), in.truth().samples, in.traced.receiver, climb.rungs[0],
                    labels_climbed, first, picture_.pixels());
    if (other_sizes_apply(in.drawn, in.record()))
      other_sizes_.add(in, climb.rungs[0], labels, picture_.pixels());
  }
  if (const auto added = add_lists(in, climb); !added) return fail(added.error());
  return detached;
}

Expected<void> LightSums::add_widths(const LadderInput& in, const Image<Label>& labels) {
  if (options_.map != nullptr) return {};
  if (texel_widths_.count() == 0 || !has_one_texel_size(in.record().map.view))
    if (const auto added = texel_widths_.append(options_.spill, texel_widths(in, labels)); !added)
      return added;
  if (in.place.first_row + labels.size.height < picture_.height) return {};
  auto widths = texel_widths_.take();
  if (!widths) return fail(widths.error());
  map_.texel_world = low_middle_high(*widths);
  return {};
}

Expected<void> LightSums::add_lists(const LadderInput& in, const Climb& climb) {
  if (const auto added = add_widths(in, climb.labels); !added || !has_curve_) return added;
  const TimedStage stage("curve");
  const Image<float>& truth = climb.rungs[0];
  ties_ += count_ties(truth, climb.labels);
  std::vector<Step> steps;
  for (const bool lit : {false, true})
    steps.emplace_back([&, lit] {
      return gaps_[lit ? 1 : 0].append(options_.spill, gaps_where(in.record(), truth, climb.labels, lit));
    });
  KindSettings found;
  if (has_kinds_) found = settings_of_kinds(in, climb.rungs, climb.labels);
  for (std::size_t k = 0; has_kinds_ && k < kind_count; ++k)
    steps.emplace_back([this, &found, k]() -> Expected<void> {
      GapLists lists;
      append_to_lists(found.settings[k], found.sides, lists);
      kinds_left_out_[k] += lists.lit_left_out;
      std::array<std::vector<float>*, side_count> sides{&lists.shadowed, &lists.lit, &lists.lit_by_lifting};
      for (std::size_t side = 0; side < side_count; ++side)
        if (const auto added = kinds_[k][side].append(options_.spill, std::move(*sides[side])); !added)
          return added;
      return {};
    });
  return run_all(steps);
}

void forget_unknown_edges(LightFigures& light, bool has_map) {
  if (has_map && (light.edges.edges > 0 || light.error.mean_absolute == 0.0)) return;
  light.edges.mean_texels = light.edges.rms_texels = light.edges.mean_absolute_texels =
      std::numeric_limits<double>::quiet_NaN();
}

void forget_texels(LightComparison& light) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  light.texel_world.fill(unknown);
  light.bias_texel_world = unknown;
  forget_unknown_edges(light, false);
  light.theory = {};
}

Expected<void> LightSums::finish(const LadderInput& in, LightComparison& out) {
  const TimedStage stage("metrics");
  out.light = in.record().light;
  out.record = in.index;
  out.pixels = sums_.pixels();
  sums_.terms().write_to(out);
  if (options_.perceptual) perception_.write_to(out.error);
  out.cascades = cascade_figures(cascades_);
  out.edges = edges_.stats();
  out.detachment = detachment_.stats();
  std::apply([&](const auto&... measure) { (measure.write_to(out), ...); }, measures_);
  if (soft_) {
    out.pixels.uncertain_by_samples = climbed_compared_ - out.pixels.compared;
    out.penumbra = penumbra_.stats();
    standard_errors_.write_to(*out.penumbra);
    weighted_.write_to(*out.penumbra);
  }
  out.bias_texel_world = in.record().texel_world;
  out.seams = seams_;
  out.ray_work = ray_work_;
  out.other_sizes = other_sizes_.figures(out.error.mean_absolute);
  static_cast<MapMeasures&>(out) = options_.map != nullptr ? *options_.map : map_;
  if (!in.drawn.has_map()) forget_texels(out);
  forget_unknown_edges(out, in.drawn.has_map());
  out.bias_curve_withheld = why_no_curve(in.drawn, in.record());
  return out.bias_curve_withheld.empty() ? finish_curve(in, out) : Expected<void>{};
}

namespace {

/// `files`: by PixelSide, of which the last may be missing.
Expected<GapLists> sorted_lists(std::span<NumberList<float>> files, std::uint64_t ties) {
  GapLists lists;
  lists.ties = ties;
  const std::array<std::vector<float>*, side_count> sides{&lists.shadowed, &lists.lit, &lists.lit_by_lifting};
  for (std::size_t side = 0; side < files.size(); ++side) {
    auto numbers = files[side].take();
    if (!numbers) return fail(numbers.error());
    sort_numbers(std::span(*numbers));
    *sides[side] = std::move(*numbers);
  }
  return lists;
}

}  // namespace

Expected<void> LightSums::finish_curve(const LadderInput& in, LightComparison& out) {
  const TimedStage stage("curve");
  const double bytes_of_lists = 12.0 * double(gaps_[0].count() + gaps_[1].count());  // with what sorts them
  std::vector<Step> steps{[&]() -> Expected<void> {
    const auto gaps = sorted_lists(gaps_, ties_);
    if (!gaps) return fail(gaps.error());
    const bool in_texels = raster::scales_bias(in.drawn.options.map);
    out.best_bias = find_advised_bias(*gaps, in_texels ? out.bias_texel_world : 1.0);
    out.bias_curve = draw_bias_curve(*gaps, out.bias_texel_world, in.record().bias_constant_world,
                                     out.best_bias.constant_world, options_.bias_curve_points);
    return {};
  }};
  const bool kinds = has_kinds_ && out.pixels.compared > 0;
  std::vector<KindOfBias> tried;
  for (const KindOfBias kind : kinds_in_order)
    if (kinds && is_tried(kind, in.drawn.options.map.bias)) tried.push_back(kind);
  out.bias_kinds.resize(tried.size());
  for (std::size_t k = 0; k < tried.size(); ++k)
    steps.emplace_back([&, k]() -> Expected<void> {
      const KindOfBias kind = tried[k];
      auto lists = sorted_lists(kinds_[kind], ties_);
      if (!lists) return fail(lists.error());
      lists->lit_left_out = kinds_left_out_[kind];
      out.bias_kinds[k] = kind_of_bias(kind, in, *lists);
      return {};
    });
  if (const auto done = run_all(steps, steps_together(bytes_of_lists)); !done) return done;
  if (kinds) sort_kinds(out.bias_kinds);
  return {};
}

}  // namespace gnomon::compare
