#include "studies/sweep/bias_axis.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "compare/bias/bias_curve.h"
#include "compare/ladder/budget.h"
#include "compare/metrics/edges.h"
#include "compare/truth/exact_depth.h"
#include "scene/base/parallel.h"

namespace gnomon::studies {
namespace {

using compare::Label;
using compare::LightComparison;
using compare::LowerClimb;
using compare::PixelTerms;

// A pixel that the bias lets light through to, for biases number `from` to `to` (excluded).
struct Gap {
  std::uint32_t pixel = 0, from = 0, to = 0;
  double distance = 0.0;
};

// One thread's share: the sums change by changes[i] from bias i - 1 to bias i.
struct Share {
  std::vector<PixelTerms> changes;
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
  BiasAxis(const LowerClimb& lower, const compare::LadderInput& in, std::span<const double> asked)
      : lower_(lower), in_(in), biases_(asked), shares_([this] {
          return Share{std::vector<PixelTerms>(biases_.count() + std::size_t{1}), {}, {}};
        }) {}

  void run() {
    parallel_for(lower_.outside.size(), [&](std::size_t i) { add_outside(lower_.outside[i]); });
    parallel_for(lower_.groups.keys.size(), [&](std::size_t g) { add_group(g); });
    totals_.assign(biases_.count() + std::size_t{1}, {});
    for (const Share& share : shares_) {
      for (std::size_t i = 0; i < totals_.size(); ++i) totals_[i].add(share.changes[i]);
      gaps_.insert(gaps_.end(), share.gaps.begin(), share.gaps.end());
      spans_.insert(spans_.end(), share.spans.begin(), share.spans.end());
    }
    for (std::size_t i = 1; i < totals_.size(); ++i) totals_[i].add(totals_[i - 1]);
    parallel_sort(std::span(gaps_), [](const Gap& a, const Gap& b) {
      return a.pixel != b.pixel ? a.pixel < b.pixel : a.from < b.from;
    });
  }

  const Biases& biases() const { return biases_; }
  std::vector<WrongSpan> take_spans() { return std::move(spans_); }
  const PixelTerms& terms(std::size_t bias) const { return totals_[bias]; }
  compare::Detachment detachment(std::size_t bias) const {
    compare::DetachmentSum sum;
    for (const Gap& gap : gaps_)
      if (bias >= gap.from && bias < gap.to) sum.add(gap.distance);
    return sum.stats();
  }

 private:
  std::uint32_t first_drawn_lit(std::uint32_t pixel) const {
    return Biases::first_lit(biases_.drawn, in_.record().gap.data[pixel]);
  }
  bool truly_lit(std::uint32_t pixel) const { return lower_.rungs[0].data[pixel] > 0.5f; }
  bool ever_wrong(std::uint32_t pixel) const {
    const std::uint32_t lit_from = first_drawn_lit(pixel);
    return truly_lit(pixel) ? lit_from > 0 : lit_from < biases_.count();
  }

  // A pixel in one state, for biases from `from` to `to` (excluded).
  void add_state(std::uint32_t pixel, const std::array<float, compare::rung_count>& v, Label label,
                 std::uint32_t from, std::uint32_t to) {
    Share& share = shares_.local();
    share.changes[from].add(v, label);
    share.changes[to].add(v, label, -1.0);
    if (compare::has_cause(label)) share.spans.push_back({pixel, from, to, label, v[6] < v[0]});
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
    compare::Column column(in_, lower_.groups.keys[group], lower_.surfaces);
    for (const std::uint32_t pixel : lower_.groups[group]) {
      compare::UpperPixel upper(lower_, in_, column, group, pixel, lower_.rungs);
      std::array<float, compare::rung_count> v = compare::rungs_at(lower_.rungs, pixel);
      const std::uint32_t biased_from = Biases::first_lit(biases_.ascending, upper.gap());
      const std::uint32_t drawn_from = first_drawn_lit(pixel);
      const auto exact = ever_wrong(pixel) ? upper.exact_gap() : std::nullopt;
      const std::uint32_t exact_from = exact ? Biases::first_lit(biases_.ascending, *exact) : biased_from;
      const auto unmoved = ever_wrong(pixel) ? upper.unmoved_gap() : std::nullopt;
      const std::uint32_t unmoved_from =
          unmoved ? Biases::first_lit(biases_.ascending, *unmoved) : biased_from;
      std::array<std::uint32_t, 6> ends{0,          biased_from,  drawn_from,
                                        exact_from, unmoved_from, biases_.count()};
      std::sort(ends.begin(), ends.end());
      for (std::size_t s = 0; s + 1 < ends.size(); ++s) {
        if (ends[s] == ends[s + 1]) continue;
        v[6] = ends[s] >= drawn_from ? 1.0f : 0.0f;
        const auto [biased, label] = upper.verdict_at(biases_.ascending[ends[s]], v[6]);
        v[5] = biased;
        add_state(pixel, v, label, ends[s], ends[s + 1]);
        if (compare::is_detached(label, v[6] < v[0])) add_gap(pixel, ends[s], ends[s + 1]);
      }
    }
  }

  void add_gap(std::uint32_t pixel, std::uint32_t from, std::uint32_t to) {
    if (const auto distance =
            compare::detachment_distance(in_.tracer, in_.light(), in_.traced.receiver.data[pixel]))
      // rounded as a map keeps it (detachment_map)
      shares_.local().gaps.push_back({pixel, from, to, double{static_cast<float>(*distance)}});
  }

  const LowerClimb& lower_;
  const compare::LadderInput& in_;
  Biases biases_;
  PerThread<Share> shares_;
  std::vector<PixelTerms> totals_;
  std::vector<Gap> gaps_;
  std::vector<WrongSpan> spans_;
};

/// What is as it was at the bias that was drawn.
LightComparison at_any_bias(const LightComparison& drawn) {
  LightComparison out;
  static_cast<compare::BiasFreeFigures&>(out) = drawn;
  out.light = drawn.light, out.record = drawn.record, out.classify = drawn.classify;
  return out;
}

}  // namespace

bool biases_add_up(const LowerClimb& lower) {
  for (std::size_t k = 0; k < 5; ++k)
    for (const float v : lower.rungs[k].data)
      if (v != 0.0f && v != 1.0f) return false;
  return true;
}

BiasTable compare_biases(const LowerClimb& lower, const compare::LadderInput& in,
                         const LightComparison& drawn, std::span<const double> asked, int bias_curve_points) {
  BiasAxis axis(lower, in, asked);
  axis.run();
  const compare::EdgePaths edges(
      {in.drawn, in.record(), in.traced.receiver, lower.rungs[0], lower.sorted, in.world()});
  const compare::GapLists gaps = compare::sort_gaps(in.record(), lower.rungs[0], lower.sorted);
  BiasTable out{std::vector<LightComparison>(asked.size()), axis.biases().place, axis.take_spans()};
  std::vector<LightComparison>& lights = out.lights;
  parallel_for(asked.size(), [&](std::size_t i) {
    const std::size_t place = axis.biases().place[i];
    lights[i] = at_any_bias(drawn);
    axis.terms(place).write_to(lights[i]);
    lights[i].detachment = axis.detachment(place);
    lights[i].edges = edges.at(static_cast<float>(asked[i]));
    compare::forget_unknown_edges(lights[i], true);
    lights[i].bias_curve = compare::draw_bias_curve(gaps, drawn.bias_texel_world, asked[i],
                                                    drawn.best_bias.constant_world, bias_curve_points);
  });
  return out;
}

}  // namespace gnomon::studies
