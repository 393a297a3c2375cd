#include "judge/advice_parts.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_kinds.h"
#include "scene/base/parallel.h"

namespace gnomon::judge {
namespace {

using compare::Advice;
using compare::AdvisedSetting;
using compare::BiasRange;
using compare::short_number_in;

/// Hardly worse than the best: by one compared pixel in 100,000, or by one wrong pixel in fifty.
constexpr double hardly_pixels = 1e-5, few_wrong = 0.02;

double hardly_more(double least) {
  return least + std::max(hardly_pixels, few_wrong * least);
}

/// A constant below 0 that is hardly wrong more often than the best of those, the one nearest to 0.
std::optional<BiasRange> good_range_below_zero(const compare::GapLists& gaps) {
  std::vector<float> starts;  // ascending: between two of them nothing changes
  for (const std::vector<float>* list : {&gaps.lit, &gaps.shadowed})
    for (const float gap : *list)
      if (gap < 0.0f && std::isfinite(gap)) starts.push_back(gap);
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  std::vector<std::uint64_t> wrong(starts.size());
  parallel_for(starts.size(), [&](std::size_t i) {
    const compare::BiasCurvePoint point = gaps.at(double{starts[i]});
    wrong[i] = point.false_shadow + point.missed_shadow;
  });
  if (starts.empty()) return std::nullopt;
  const auto least = static_cast<double>(*std::min_element(wrong.begin(), wrong.end()));
  const double allowed = least + std::max(hardly_pixels * double(gaps.count()), few_wrong * least);
  std::size_t last = starts.size() - 1;
  while (double(wrong[last]) > allowed) --last;
  std::size_t first = last;
  while (first > 0 && double(wrong[first - 1]) <= allowed) --first;
  return BiasRange{starts[first], last + 1 < starts.size() ? starts[last + 1] : 0.0f};
}

}  // namespace

double TriedConstants::wrong(std::uint64_t inside) const {
  return (double(inside + outside_wrong) + 0.5 * double(gaps.ties + outside_ties)) / std::max(1.0, pixels());
}

std::uint64_t TriedConstants::inside_at(double bias) const {
  const compare::BiasCurvePoint point = gaps.at(bias);
  return point.false_shadow + point.missed_shadow;
}

GoodConstant good_constant(const TriedConstants& tried, double unit_world, double now) {
  const BiasRange range = compare::smallest_good_range(tried.gaps);
  const auto at = [&](double stored) { return GoodConstant{stored, tried.wrong_at(stored * unit_world)}; };
  GoodConstant best = at(short_number_in(range.from / unit_world, range.to / unit_world));
  if (const auto below = good_range_below_zero(tried.gaps)) {
    const double most = -double{below->from} / unit_world;
    const double least = std::max(std::nextafter(-double{below->to} / unit_world, infinity), 1e-3 * most);
    const GoodConstant negative = at(-short_number_in(least, most));
    if (negative.left < worth_changing * best.left) best = negative;
  }
  const GoodConstant present = at(now);
  return present.left <= hardly_more(best.left) ? present : best;
}

TriedConstants try_constants(const raster::LightRecord& record, const compare::LightComparison& light,
                             int face) {
  TriedConstants out;
  Image<compare::Label> inside = light.labels;
  for (std::size_t i = 0; i < inside.data.size(); ++i) {
    if (face >= 0 && record.face.data[i] != face) inside.data[i] = compare::Label::background;
    if (!compare::is_compared(inside.data[i]) || record.outside_map.data[i] == 0) continue;
    inside.data[i] = compare::Label::background;
    const float off = std::abs(light.rungs[6].data[i] - light.rungs[0].data[i]);
    ++out.outside, out.outside_wrong += off > 0.5f ? 1 : 0, out.outside_ties += off == 0.5f ? 1 : 0;
  }
  out.gaps = compare::sort_gaps(record, light.rungs[0], inside);
  return out;
}

namespace {

/// A short number in [from, to], where there is one beside the ends of that.
double short_number_within(double from, double to) {
  if (from <= 0.0 && to >= 0.0) return 0.0;
  if (from < 0.0) return -short_number_within(-to, -from);
  return from < to ? short_number_in(from, to) : from;
}

/// What constants leave, ascending.
struct Tries {
  std::vector<double> constants;  ///< world units
  std::vector<Redrawn> left;
  double most_wrong = 1.0;  ///< of those that may be taken

  bool may_be(std::size_t i) const { return left[i].wrong_fraction <= most_wrong; }
  std::size_t best() const {
    std::size_t out = 0;
    for (std::size_t i = 1; i < left.size(); ++i)
      if (may_be(i) > may_be(out) ||
          (may_be(i) == may_be(out) && left[i].most_mean() < left[out].most_mean()))
        out = i;
    return out;
  }
};

/// A sample drawn again with telling constants, and once more with some around the best of these.
GoodConstant good_filtered_constant(const ConstantSearch& search, const TestedRecord& record, int face) {
  constexpr int between = 8;
  const Redrawing::Pixels pixels{.sample = true, .face = face};
  const double present = search.now * search.unit_world;
  const Redrawn drawn = search.redrawing.redraw(search.redrawing.as_drawn(), {present}, pixels).front();
  Tries tries{search.redrawing.telling_constants(record, pixels), {}, drawn.wrong_fraction};
  for (int round = 0; round < 2; ++round) {
    tries.left = search.redrawing.redraw(record, tries.constants, pixels);
    if (round == 1) break;
    const std::size_t best = tries.best(), last = tries.constants.size() - 1;
    const double from = tries.constants[best > 0 ? best - 1 : 0],
                 to = tries.constants[std::min(best + 1, last)];
    for (int k = 1; k < between; ++k) tries.constants.push_back(from + (to - from) * k / between);
    std::sort(tries.constants.begin(), tries.constants.end());
  }
  const std::size_t best = tries.best();
  const double enough = hardly_more(tries.left[best].most_mean());
  const auto is_good = [&](std::size_t i) {
    return tries.may_be(i) == tries.may_be(best) && tries.left[i].most_mean() <= enough;
  };
  std::size_t first = best, last = best;
  while (first > 0 && is_good(first - 1)) --first;
  while (last + 1 < tries.constants.size() && is_good(last + 1)) ++last;
  for (std::size_t i = first; i <= last; ++i)
    if (tries.constants[i] == present) return {search.now, tries.left[i].most_mean()};
  const double unit = search.unit_world;
  return {short_number_within(tries.constants[first] / unit, tries.constants[last] / unit),
          tries.left[best].most_mean()};
}

}  // namespace

GoodConstant ConstantSearch::best_beside(TestedRecord& record, int face) const {
  if (!redrawing.compares_once()) return good_filtered_constant(*this, record, face);
  fill_record(in, bias, record.own);
  return good_constant(try_constants(record.own, light, face), unit_world, now);
}

double ConstantSearch::left_at(TestedRecord& record, double stored) const {
  if (!redrawing.compares_once())
    return redrawing.redraw(record, {stored * unit_world}, {.sample = true}).front().most_mean();
  fill_record(in, bias, record.own);
  return try_constants(record.own, light).wrong_at(stored * unit_world);
}

namespace {

/// A layer's constant in stored numbers, of all that its test has.
struct LayerConstant {
  int face;
  double beside;  ///< stored numbers beside the first layer's constant
  double range, texel_world;

  LayerConstant(const raster::LightRecord& record, int of_face)
      : face(of_face), texel_world(texel_world_size(record.map.view, of_face, 1.0)) {
    beside = captured_test(record).constant_beside(face);
    const LightFace& f = record.map.view.face(face);
    range = f.far_depth - f.near_depth;
  }
  AdvisedSetting instead(double now, double stored) const {
    return {fmt::format("map[{}].bias.constant_depth", face),
            now + beside,
            stored,
            "stored depth",
            range,
            texel_world};
  }
};

std::vector<LayerConstant> layers_of(const ConstantSearch& search) {
  const raster::LightRecord& record = search.redrawing.as_drawn().own;
  std::vector<LayerConstant> out;
  for (int face = 0; face < record.map.view.face_count; ++face) out.emplace_back(record, face);
  return out;
}

Advice of_layers(const std::vector<AdvisedSetting>& settings) {
  Advice out;
  static_cast<AdvisedSetting&>(out) = settings.front();
  out.layers.assign(settings.begin() + 1, settings.end());
  return out;
}

/// The gaps of all layers as multiples of each one's texel.
TriedConstants tried_in_texels(const ConstantSearch& search, const std::vector<LayerConstant>& layers) {
  TriedConstants all;
  for (const LayerConstant& layer : layers) {
    TriedConstants tried = try_constants(search.redrawing.as_drawn().own, search.light, layer.face);
    for (const auto& [from, to] :
         {std::pair(&tried.gaps.lit, &all.gaps.lit), std::pair(&tried.gaps.shadowed, &all.gaps.shadowed)})
      for (const float gap : *from)
        to->push_back(static_cast<float>((double{gap} / search.unit_world + layer.beside) * layer.range /
                                         layer.texel_world));
    all.gaps.lit_left_out += tried.gaps.lit_left_out, all.gaps.ties += tried.gaps.ties;
    all.outside += tried.outside, all.outside_wrong += tried.outside_wrong;
    all.outside_ties += tried.outside_ties;
  }
  std::sort(all.gaps.lit.begin(), all.gaps.lit.end());
  std::sort(all.gaps.shadowed.begin(), all.gaps.shadowed.end());
  return all;
}

/// Of a filter, the middle of the layers' own constants that suits them together, by a sample.
double filtered_texels(const ConstantSearch& search, const std::vector<LayerConstant>& layers) {
  TestedRecord record = search.redrawing.as_drawn();
  std::vector<double> texels{0.0};
  for (const LayerConstant& layer : layers)
    texels.push_back((good_filtered_constant(search, record, layer.face).stored + layer.beside) *
                     layer.range / layer.texel_world);
  double best = 0.0, least = infinity;
  for (const double t : texels) {
    const double tried = compare::rounded_to_three(t);
    record.change([&](raster::LightRecord& one) {
      auto& own = changed_test(one).layers;
      own.resize(layers.size());
      for (std::size_t i = 0; i < layers.size(); ++i)
        own[i].constant = tried * layers[i].texel_world / layers[i].range;
    });
    if (const double left = search.left_at(record, 0.0); left < least) least = left, best = tried;
  }
  return best;
}

}  // namespace

bool has_layers(const raster::LightRecord& record) {
  const LightView& view = record.map.view;
  return view.face_count >= 2 && view.projection == LightProjection::orthographic &&
         !captured_test(record).has_angle();
}

Advice advise_in_texels(const ConstantSearch& search) {
  const std::vector<LayerConstant> layers = layers_of(search);
  double texels = 0.0;
  if (search.redrawing.compares_once()) {
    const BiasRange range = compare::smallest_good_range(tried_in_texels(search, layers).gaps);
    texels = short_number_in(range.from, range.to);
  } else {
    texels = filtered_texels(search, layers);
  }
  std::vector<AdvisedSetting> settings;
  for (const LayerConstant& layer : layers)
    settings.push_back(layer.instead(search.now, texels * layer.texel_world / layer.range));
  Advice out = of_layers(settings);
  out.texels_of_each = texels;
  return out;
}

Advice advise_on_layers(const ConstantSearch& search) {
  TestedRecord record = search.redrawing.as_drawn();
  std::vector<AdvisedSetting> settings;
  for (const LayerConstant& layer : layers_of(search))
    settings.push_back(
        layer.instead(search.now, search.best_beside(record, layer.face).stored + layer.beside));
  return of_layers(settings);
}

}  // namespace gnomon::judge
