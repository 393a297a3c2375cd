#include "compare/sweep/bias_axis.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "compare/bias_curve.h"
#include "compare/budget.h"
#include "compare/edges.h"
#include "compare/exact_depth.h"
#include "compare/labelling.h"
#include "scene/parallel.h"

namespace gnomon::compare {
namespace {

// What one pixel adds to the counts of a bias.
struct Counts {
  std::int64_t false_shadow = 0, missed_shadow = 0;
  std::array<std::int64_t, class_count> classes{};
  std::array<std::int64_t, cause_count> signed_steps{}, absolute_steps{};
  std::array<std::int64_t, rung_count> rungs{};
  std::array<std::int64_t, cause_count> blamed_false{}, blamed_missed{};
  std::int64_t accidents_shadowed = 0, accidents_lit = 0;

  void add(const Counts& other, std::int64_t sign) {
    false_shadow += sign * other.false_shadow;
    missed_shadow += sign * other.missed_shadow;
    for (std::size_t k = 0; k < class_count; ++k) classes[k] += sign * other.classes[k];
    for (std::size_t k = 0; k < cause_count; ++k) {
      signed_steps[k] += sign * other.signed_steps[k];
      absolute_steps[k] += sign * other.absolute_steps[k];
      blamed_false[k] += sign * other.blamed_false[k];
      blamed_missed[k] += sign * other.blamed_missed[k];
    }
    accidents_shadowed += sign * other.accidents_shadowed;
    accidents_lit += sign * other.accidents_lit;
    for (std::size_t k = 0; k < rung_count; ++k) rungs[k] += sign * other.rungs[k];
  }
};

// A pixel that the bias lets light through to, for biases number `from` to `to` (excluded).
struct Gap {
  std::uint32_t pixel = 0, from = 0, to = 0;
  double distance = 0.0;
};

// One thread's share: counts[i] changes from bias i - 1 to bias i.
struct Share {
  std::vector<Counts> changes;
  std::vector<Gap> gaps;
  std::vector<WrongSpan> spans;
};

struct Biases {
  std::vector<double> ascending;
  std::vector<float> drawn;        ///< as the shader has them
  std::vector<std::size_t> place;  ///< ascending[place[i]] is the i-th asked for

  explicit Biases(std::span<const double> asked) : place(asked.size()) {
    std::vector<std::size_t> order(asked.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return asked[a] < asked[b]; });
    for (std::size_t i = 0; i < order.size(); ++i) {
      ascending.push_back(asked[order[i]]);
      drawn.push_back(static_cast<float>(asked[order[i]]));
      place[order[i]] = i;
    }
  }
  /// The first bias that lets light through a gap; NaN is no gap.
  template <class Value>
  static std::uint32_t first_lit(const std::vector<Value>& biases, Value gap) {
    if (std::isnan(gap)) return 0;
    return static_cast<std::uint32_t>(std::lower_bound(biases.begin(), biases.end(), gap) - biases.begin());
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(ascending.size()); }
};

class BiasAxis {
 public:
  BiasAxis(const LowerClimb& lower, const LadderInput& in, std::span<const double> asked)
      : lower_(lower), in_(in), biases_(asked), shares_([this] {
          return Share{std::vector<Counts>(biases_.count() + std::size_t{1}), {}, {}};
        }) {}

  void run() {
    parallel_for(lower_.outside.size(), [&](std::size_t i) { add_outside(lower_.outside[i]); });
    parallel_for(lower_.groups.keys.size(), [&](std::size_t g) { add_group(g); });
    totals_.assign(biases_.count() + std::size_t{1}, {});
    for (const Share& share : shares_) {
      for (std::size_t i = 0; i < totals_.size(); ++i) totals_[i].add(share.changes[i], 1);
      gaps_.insert(gaps_.end(), share.gaps.begin(), share.gaps.end());
      spans_.insert(spans_.end(), share.spans.begin(), share.spans.end());
    }
    for (std::size_t i = 1; i < totals_.size(); ++i) totals_[i].add(totals_[i - 1], 1);
    tbb::parallel_sort(gaps_, [](const Gap& a, const Gap& b) {
      return a.pixel != b.pixel ? a.pixel < b.pixel : a.from < b.from;
    });
  }

  const Biases& biases() const { return biases_; }
  std::vector<WrongSpan> take_spans() { return std::move(spans_); }
  const Counts& counts(std::size_t bias) const { return totals_[bias]; }
  Detachment detachment(std::size_t bias) const {
    DetachmentSum sum;
    for (const Gap& gap : gaps_)
      if (bias >= gap.from && bias < gap.to) sum.add(gap.distance);
    return sum.stats();
  }

 private:
  std::uint32_t first_drawn_lit(std::uint32_t pixel) const {
    return Biases::first_lit(biases_.drawn, in_.record.gap.data[pixel]);
  }
  bool truly_lit(std::uint32_t pixel) const { return lower_.rungs[0].data[pixel] > 0.5f; }
  bool ever_wrong(std::uint32_t pixel) const {
    const std::uint32_t lit_from = first_drawn_lit(pixel);
    return truly_lit(pixel) ? lit_from > 0 : lit_from < biases_.count();
  }

  // Counts of a pixel in one state, for biases from `from` to `to` (excluded).
  void add_state(std::uint32_t pixel, const std::array<float, rung_count>& v, Label label, std::uint32_t from,
                 std::uint32_t to) {
    Counts counts;
    counts.false_shadow = v[6] < v[0];
    counts.missed_shadow = v[6] > v[0];
    if (is_wrong(label)) {
      const auto step = static_cast<std::size_t>(step_of_label(label, v));
      counts.classes[static_cast<std::size_t>(label) - 1] = 1;
      (counts.false_shadow != 0 ? counts.blamed_false : counts.blamed_missed)[step] = 1;
    }
    counts.accidents_shadowed = is_accident(v) && v[0] < 0.5f ? 1 : 0;
    counts.accidents_lit = is_accident(v) && v[0] > 0.5f ? 1 : 0;
    for (std::size_t k = 0; k < rung_count; ++k) counts.rungs[k] = v[k] > 0.5f;
    for (std::size_t k = 0; k < cause_count; ++k) {
      counts.signed_steps[k] = counts.rungs[k + 1] - counts.rungs[k];
      counts.absolute_steps[k] = std::abs(counts.signed_steps[k]);
    }
    Share& share = shares_.local();
    share.changes[from].add(counts, 1);
    share.changes[to].add(counts, -1);
    if (is_wrong(label)) share.spans.push_back({pixel, from, to, label, v[6] < v[0]});
  }

  void add_outside(std::uint32_t pixel) {
    const std::uint32_t lit_from = first_drawn_lit(pixel);
    const float truth = lower_.rungs[0].data[pixel];
    for (const float drawn : {0.0f, 1.0f}) {
      const std::uint32_t from = drawn == 0.0f ? 0 : lit_from,
                          to = drawn == 0.0f ? lit_from : biases_.count();
      if (from == to) continue;
      const Label label = drawn == truth ? Label::right : Label::outside_map;
      add_state(pixel, {truth, lower_.rungs[1].data[pixel], drawn, drawn, drawn, drawn, drawn}, label, from,
                to);
    }
  }

  void add_group(std::size_t group) {
    Column column(in_, lower_.groups.keys[group], lower_.surfaces);
    for (const std::uint32_t pixel : lower_.groups[group]) {
      raytrace::TexelKey lookup = lower_.groups.keys[group];
      const double gap = gap_with_bias(lower_, in_, group, pixel, lookup);
      const std::uint32_t biased_from = Biases::first_lit(biases_.ascending, gap);
      const std::uint32_t drawn_from = first_drawn_lit(pixel);
      const auto exact = ever_wrong(pixel) ? exact_gap(lower_, in_, group, pixel) : std::nullopt;
      const std::uint32_t exact_from = exact ? Biases::first_lit(biases_.ascending, *exact) : biased_from;
      std::array<std::uint32_t, 5> ends{0, biased_from, drawn_from, exact_from, biases_.count()};
      std::sort(ends.begin(), ends.end());
      std::array<float, rung_count> v{};
      for (std::size_t k = 0; k < 5; ++k) v[k] = lower_.rungs[k].data[pixel];
      for (std::size_t s = 0; s + 1 < ends.size(); ++s) {
        if (ends[s] == ends[s + 1]) continue;
        v[5] = ends[s] >= biased_from ? 1.0f : 0.0f;
        v[6] = ends[s] >= drawn_from ? 1.0f : 0.0f;
        Label label = Label::right;
        if (v[6] != v[0]) {
          const bool exact_is_right = exact && v[5] != v[0] && (ends[s] >= exact_from ? 1.0f : 0.0f) == v[0];
          label = label_wrong_pixel(in_, column,
                                    {pixel, lookup, deciding_step(v), v[6] < v[0], exact_is_right, v[0]});
        }
        add_state(pixel, v, label, ends[s], ends[s + 1]);
        if (label == Label::peter_panning) add_gap(pixel, ends[s], ends[s + 1]);
      }
    }
  }

  void add_gap(std::uint32_t pixel, std::uint32_t from, std::uint32_t to) {
    if (const auto distance = detachment_distance(in_.tracer, in_.light, in_.traced.receiver.data[pixel]))
      // rounded as a map keeps it (detachment_map)
      shares_.local().gaps.push_back({pixel, from, to, double{static_cast<float>(*distance)}});
  }

  const LowerClimb& lower_;
  const LadderInput& in_;
  Biases biases_;
  PerThread<Share> shares_;
  std::vector<Counts> totals_;
  std::vector<Gap> gaps_;
  std::vector<WrongSpan> spans_;
};

// As measure_pixels has it, from counts instead of images.
void fill_counts(const Counts& counts, LightComparison& out) {
  out.classes = {};
  for (std::size_t k = 0; k < class_count; ++k)
    out.classes[k] = static_cast<std::uint64_t>(counts.classes[k]);
  out.accidents = {static_cast<std::uint64_t>(counts.accidents_shadowed),
                   static_cast<std::uint64_t>(counts.accidents_lit)};
  out.error = {};
  out.budget = {};
  out.rung_mean = {};
  out.error.false_shadow = static_cast<std::uint64_t>(counts.false_shadow);
  out.error.missed_shadow = static_cast<std::uint64_t>(counts.missed_shadow);
  out.error.wrong = out.error.false_shadow + out.error.missed_shadow;
  const auto count = static_cast<double>(out.pixels.compared);
  if (!(count > 0.0)) return;
  out.error.wrong_fraction = double(out.error.wrong) / count;
  out.error.mean_absolute = double(out.error.wrong) / count;
  out.error.rms = std::sqrt(double(out.error.wrong) / count);
  for (std::size_t k = 0; k < cause_count; ++k)
    out.budget[k] = {double(counts.signed_steps[k]) / count, double(counts.absolute_steps[k]) / count,
                     static_cast<std::uint64_t>(counts.blamed_false[k]),
                     static_cast<std::uint64_t>(counts.blamed_missed[k])};
  for (std::size_t k = 0; k < rung_count; ++k) out.rung_mean[k] = double(counts.rungs[k]) / count;
}

// Everything but the images.
LightComparison without_images(const LightComparison& light) {
  LightComparison out;
  out.light = light.light;
  out.record = light.record;
  out.pixels = light.pixels;
  out.best_bias = light.best_bias;
  out.lookups = light.lookups;
  out.texel_world = light.texel_world;
  out.bias_texel_world = light.bias_texel_world;
  out.theory = light.theory;
  out.classify = light.classify;
  return out;
}

}  // namespace

bool biases_add_up(const LowerClimb& lower) {
  for (std::size_t k = 0; k < 5; ++k)
    for (const float v : lower.rungs[k].data)
      if (v != 0.0f && v != 1.0f) return false;
  return true;
}

BiasTable compare_biases(const LowerClimb& lower, const LadderInput& in, const LightComparison& drawn,
                         std::span<const double> asked, int bias_curve_points) {
  BiasAxis axis(lower, in, asked);
  axis.run();
  const EdgePaths edges({in.drawn, in.record, in.traced.receiver, lower.rungs[0], lower.sorted, in.world});
  const GapLists gaps = sort_gaps(in.record, lower.rungs[0], lower.sorted);
  BiasTable out{std::vector<LightComparison>(asked.size()), axis.biases().place, axis.take_spans()};
  std::vector<LightComparison>& lights = out.lights;
  parallel_for(asked.size(), [&](std::size_t i) {
    const std::size_t place = axis.biases().place[i];
    lights[i] = without_images(drawn);
    fill_counts(axis.counts(place), lights[i]);
    lights[i].detachment = axis.detachment(place);
    lights[i].edges = edges.at(static_cast<float>(asked[i]));
    lights[i].bias_curve = draw_bias_curve(gaps, drawn.bias_texel_world, asked[i],
                                           drawn.best_bias.constant_world, bias_curve_points);
  });
  return out;
}

}  // namespace gnomon::compare
