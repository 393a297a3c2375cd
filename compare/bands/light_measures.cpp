#include "compare/bands/light_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "compare/bands/run_all.h"
#include "compare/cascades.h"
#include "compare/flip.h"
#include "compare/shadow_cost.h"
#include "compare/ssim.h"
#include "compare/ssim_rows.h"
#include "scene/sort_numbers.h"
#include "scene/stages.h"

namespace gnomon::compare {
namespace {

constexpr int perception_margin = 64;  // rows; more than the filters of FLIP and SSIM reach

/// Rows wanted and as many around them as there are.
PictureRows widened(const PictureRows& rows, int by, int height) {
  const int first = std::max(0, rows.first - by), end = std::min(height, rows.end() + by);
  return {first, end - first};
}

}  // namespace

Expected<Image<float>> LightMeasures::add_pixels(const LadderInput& in, const Climb& climbed,
                                                 const Image<Label>& labels_climbed, const BandPlace& place) {
  const TimedStage stage("metrics");
  const Image<Label>& labels = climbed.labels;
  if (!begun_) {
    cascades_ = sums_of_cascades(in.drawn, in.record);
    soft_ = !in.truth.visibility.data.empty();
    has_curve_ = why_no_curve(in.drawn, in.record).empty();
    has_kinds_ = has_curve_ && perceptual_ && kinds_apply(in.drawn, in.record);
    begun_ = true;
  }
  sums_.add(climbed.rungs, labels);
  for (CascadeSums& cascade : cascades_) cascade.add(in.record, climbed.rungs, labels);
  climbed_compared_ += count_pixels(labels_climbed).compared;
  if (soft_) {
    standard_errors_.add(in.truth, labels);
    penumbra_.add(in, climbed.rungs.front(), labels_climbed);
  }
  Image<float> detached = detachment_map(in.tracer, in.light, in.traced.receiver, labels);
  for (const float distance : detached.data)
    if (!std::isnan(distance)) detachment_.add(double{distance});
  bleeding_.add(in, climbed.rungs, labels);
  if (const auto lookups = count_lookups(in.drawn, in.record, labels))
    lookups_ = lookups_.value_or(0) + *lookups;
  if (perceptual_) {
    const std::size_t first = in.traced.receiver.index(0, place.rows.first);
    add_ray_work(in.tracer, in.light, in.traced.receiver, labels, first, place.picture.pixels(), ray_work_);
  }
  if (const auto added = add_lists(in, climbed); !added) return fail(added.error());
  return detached;
}

Expected<void> LightMeasures::add_lists(const LadderInput& in, const Climb& climbed) {
  std::vector<double> widths = texel_widths(in, climbed.labels);
  if (has_one_texel_size(in.record.map.view)) {
    if (texel_width_.empty()) texel_width_ = std::move(widths);
  } else if (const auto added = texel_widths_.append(folder_, widths); !added) {
    return added;
  }
  if (!has_curve_) return {};
  const Image<float>& truth = climbed.rungs[0];
  ties_ += count_ties(truth, climbed.labels);
  std::vector<Step> steps;
  for (const bool lit : {false, true})
    steps.emplace_back([&, lit] {
      return gaps_[lit ? 1 : 0].append(folder_, gaps_where(in.record, truth, climbed.labels, lit));
    });
  KindSettings found;
  if (has_kinds_) found = settings_of_kinds(in, truth, climbed.labels);
  for (std::size_t k = 0; has_kinds_ && k < kind_count; ++k)
    steps.emplace_back([this, &found, k]() -> Expected<void> {
      GapLists lists;
      put_into_lists(found.settings[k], found.lit, lists);
      kinds_left_out_[k] += lists.lit_left_out;
      if (const auto added = kinds_[k][0].append(folder_, lists.shadowed); !added) return added;
      return kinds_[k][1].append(folder_, lists.lit);
    });
  return run_all(steps);
}

Expected<FinishedMaps> LightMeasures::add_neighbours(const LadderInput& near, const NearLight& light,
                                                     int first_row, const BandPlace& place) {
  const TimedStage stage("metrics");
  const PictureRows here{place.rows.first - first_row, place.rows.count};
  const EdgeInput edges{near.drawn, near.record, near.traced.receiver, light.truth, light.climbed,
                        near.world, first_row};
  FinishedMaps maps;
  add_edges(edges, here, edges_);
  if (const auto seams = count_seams(near, light.labels, here)) {
    SeamCount& sum = seams_ ? *seams_ : seams_.emplace();
    sum.at_border += seams->at_border, sum.changed += seams->changed;
  }
  TheoryValues values = theory_values(near, light.labels, here, place.picture.height);
  std::vector<Step> steps;
  for (std::size_t k = 0; k < values.size(); ++k)
    steps.emplace_back([this, k, &values] {
      std::erase_if(values[k], [](double v) { return !std::isfinite(v); });
      return theory_[k].append(folder_, values[k]);
    });
  if (const auto added = run_all(steps); !added) return fail(added.error());
  if (!perceptual_) return maps;
  maps.edges = edge_displacement_rows(edges, here);
  add_perception(light, first_row, place, maps);
  return maps;
}

void LightMeasures::add_perception(const NearLight& light, int first_row, const BandPlace& place,
                                   FinishedMaps& maps) {
  const PictureRows wide = widened(place.rows, perception_margin, place.picture.height);
  const PictureRows wide_here{wide.first - first_row, wide.count};
  const Image<Label> labels = cut_rows(light.labels, wide_here);
  const Image<float> truth = visibility_picture(cut_rows(light.truth, wide_here), labels);
  const Image<float> drawn = visibility_picture(cut_rows(light.drawn, wide_here), labels);
  const PictureRows inner{place.rows.first - wide.first, place.rows.count};
  maps.flip = cut_rows(flip_error(truth, drawn), inner);
  for (int y = 0; y < maps.flip.size.height; ++y) {
    double row = 0.0;
    for (int x = 0; x < maps.flip.size.width; ++x) row += static_cast<double>(maps.flip.at(x, y));
    flip_sum_ += row;
  }
  flips_ += maps.flip.data.size();
  maps.ssim = cut_rows(ssim_by_pixel(ssim_map(truth, drawn), truth.size), inner);
  constexpr int middle = ssim_window / 2;
  for (int y = 0; y < maps.ssim.size.height; ++y) {
    const int row = place.rows.first + y;
    if (row < middle || row >= place.picture.height - middle) continue;
    for (int x = middle; x < maps.ssim.size.width - middle; ++x)
      ssim_sum_ += static_cast<double>(maps.ssim.at(x, y)), ++ssims_;
  }
  const Image<Label> core = cut_rows(labels, inner);
  flip_compared_.add(maps.flip, core), ssim_compared_.add(maps.ssim, core);
}

Expected<LightComparison> LightMeasures::finish(const LadderInput& in, std::size_t record) {
  const TimedStage stage("metrics");
  LightComparison out;
  out.light = in.record.light;
  out.record = record;
  out.pixels = sums_.pixels(), out.classes = sums_.classes();
  out.error = sums_.error(), out.budget = sums_.budget();
  out.accidents = sums_.accidents(), out.rung_mean = sums_.rung_means();
  if (perceptual_) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    out.error.flip = flips_ == 0 ? 0.0 : flip_sum_ / static_cast<double>(flips_);
    out.error.ssim = ssims_ == 0 ? none : ssim_sum_ / static_cast<double>(ssims_);
    out.error.flip_compared = flip_compared_.mean(), out.error.ssim_compared = ssim_compared_.mean();
  }
  out.edges = edges_.stats();
  out.detachment = detachment_.stats();
  out.bleeding = bleeding_.stats();
  if (soft_) {
    out.pixels.uncertain_by_samples = climbed_compared_ - out.pixels.compared;
    out.penumbra = penumbra_.stats();
    standard_errors_.put(*out.penumbra);
  }
  out.bias_texel_world = in.record.texel_world;
  out.seams = seams_;
  out.lookups = lookups_;
  out.ray_work = ray_work_;
  if (const auto lists = finish_lists(in, out); !lists) return fail(lists.error());
  return out;
}

Expected<void> LightMeasures::finish_lists(const LadderInput& in, LightComparison& out) {
  if (texel_width_.empty()) {
    auto widths = texel_widths_.take();
    if (!widths) return fail(widths.error());
    texel_width_ = std::move(*widths);
  }
  out.texel_world = low_middle_high(texel_width_);
  texel_width_ = {};
  std::vector<Step> steps;
  for (std::size_t k = 0; k < theory_.size(); ++k)
    steps.emplace_back([this, k, &out]() -> Expected<void> {
      auto values = theory_[k].take();
      if (!values) return fail(values.error());
      distribution_of(out.theory, k) = distribution(*values);
      return {};
    });
  const auto most = std::max_element(theory_.begin(), theory_.end(),
                                     [](const auto& a, const auto& b) { return a.count() < b.count(); });
  if (const auto done = run_all(steps, steps_together(8.0 * double(most->count()))); !done) return done;
  out.bias_curve_withheld = why_no_curve(in.drawn, in.record);
  return out.bias_curve_withheld.empty() ? finish_curve(in, out) : Expected<void>{};
}

namespace {

Expected<GapLists> sorted_lists(std::array<NumberFile<float>, 2>& files, std::uint64_t ties) {
  GapLists lists;
  lists.ties = ties;
  for (const bool lit : {false, true}) {
    auto numbers = files[lit ? 1 : 0].take();
    if (!numbers) return fail(numbers.error());
    sort_numbers(std::span(*numbers));
    (lit ? lists.lit : lists.shadowed) = std::move(*numbers);
  }
  return lists;
}

}  // namespace

Expected<void> LightMeasures::finish_curve(const LadderInput& in, LightComparison& out) {
  const TimedStage stage("curve");
  const double bytes_of_lists = 12.0 * double(gaps_[0].count() + gaps_[1].count());  // with what sorts them
  std::vector<Step> steps{[&]() -> Expected<void> {
    const auto gaps = sorted_lists(gaps_, ties_);
    if (!gaps) return fail(gaps.error());
    out.best_bias = find_advised_bias(*gaps);
    out.bias_curve = draw_bias_curve(*gaps, out.bias_texel_world, in.record.bias_constant_world,
                                     out.best_bias.constant_world, curve_points_);
    return {};
  }};
  const bool kinds = has_kinds_ && out.pixels.compared > 0;
  if (kinds) out.bias_kinds.resize(kinds_in_order.size());
  for (std::size_t k = 0; k < out.bias_kinds.size(); ++k)
    steps.emplace_back([&, k]() -> Expected<void> {
      const KindOfBias kind = kinds_in_order[k];
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
