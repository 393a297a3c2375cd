#include "studies/judge/advice_parts.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_kinds.h"
#include "compare/ladder/biased_test.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::compare {
namespace {

/// Hardly worse than the best: by one compared pixel in 100,000, or by one wrong pixel in fifty.
constexpr double hardly_pixels = 1e-5, few_wrong = 0.02;

/// A constant below 0 that is hardly wrong more often than the best of those, the one nearest to 0.
std::optional<BiasRange> good_range_below_zero(const GapLists& gaps) {
  std::vector<float> starts;  // ascending: between two of them nothing changes
  for (const std::vector<float>* list : {&gaps.lit, &gaps.shadowed})
    for (const float gap : *list)
      if (gap < 0.0f && std::isfinite(gap)) starts.push_back(gap);
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  std::vector<std::uint64_t> wrong(starts.size());
  parallel_for(starts.size(), [&](std::size_t i) {
    const BiasCurvePoint point = gaps.at(double{starts[i]});
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
  const BiasCurvePoint point = gaps.at(bias);
  return point.false_shadow + point.missed_shadow;
}

GoodConstant good_constant(const TriedConstants& tried, double unit_world, double now) {
  const BiasRange range = smallest_good_range(tried.gaps);
  const auto at = [&](double stored) { return GoodConstant{stored, tried.wrong_at(stored * unit_world)}; };
  GoodConstant best = at(short_number_in(range.from / unit_world, range.to / unit_world));
  if (const auto below = good_range_below_zero(tried.gaps)) {
    const double most = -double{below->from} / unit_world;
    const double least = std::max(std::nextafter(-double{below->to} / unit_world, infinity), 1e-3 * most);
    const GoodConstant negative = at(-short_number_in(least, most));
    if (negative.wrong < worth_changing * best.wrong) best = negative;
  }
  const GoodConstant present = at(now);
  const double hardly = std::max(hardly_pixels, few_wrong * best.wrong);
  return present.wrong <= best.wrong + hardly ? present : best;
}

TriedConstants try_constants(const raster::LightRecord& record, const LightComparison& light, int face) {
  TriedConstants out;
  Image<Label> inside = light.labels;
  for (std::size_t i = 0; i < inside.data.size(); ++i) {
    if (face >= 0 && record.face.data[i] != face) inside.data[i] = Label::background;
    if (!is_compared(inside.data[i]) || record.outside_map.data[i] == 0) continue;
    inside.data[i] = Label::background;
    const float off = std::abs(light.rungs[6].data[i] - light.rungs[0].data[i]);
    ++out.outside, out.outside_wrong += off > 0.5f ? 1 : 0, out.outside_ties += off == 0.5f ? 1 : 0;
  }
  out.gaps = sort_gaps(record, light.rungs[0], inside);
  return out;
}

namespace {

/// Whether the layers of a record's map can each have a constant of their own that counts alike at every angle.
bool has_layers(const raster::LightRecord& record) {
  const LightView& view = record.map.view;
  return view.face_count >= 2 && view.projection == LightProjection::orthographic &&
         !record.captured->test->has_angle();
}

/// A layer's constant in stored numbers, of all that its test has.
struct LayerConstant {
  int face;
  double beside;  ///< stored numbers beside the first layer's constant
  double range, texel_world;

  LayerConstant(const raster::LightRecord& record, int of_face)
      : face(of_face), texel_world(texel_world_size(record.map.view, of_face, 1.0)) {
    const auto& layers = record.captured->test->layers;
    beside = layers.empty() ? 0.0 : layers[static_cast<std::size_t>(face)].constant;
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

Advice of_layers(const std::vector<AdvisedSetting>& settings, double wrong_now, double instead) {
  Advice out;
  static_cast<AdvisedSetting&>(out) = settings.front();
  out.wrong_now = wrong_now, out.wrong_instead = instead, out.feasible = instead == 0.0;
  out.layers.assign(settings.begin() + 1, settings.end());
  return out;
}

}  // namespace

std::optional<Advice> advise_in_texels(const LightComparison& light, const raster::LightRecord& record,
                                       double wrong_now, double least) {
  if (!has_layers(record)) return std::nullopt;
  const double unit = record.captured->test->unit_world;
  std::vector<LayerConstant> layers;
  TriedConstants all;  // by texels of the layer
  for (int face = 0; face < record.map.view.face_count; ++face) {
    const LayerConstant& layer = layers.emplace_back(record, face);
    TriedConstants tried = try_constants(record, light, face);
    for (const auto& [from, to] :
         {std::pair(&tried.gaps.lit, &all.gaps.lit), std::pair(&tried.gaps.shadowed, &all.gaps.shadowed)})
      for (const float gap : *from)
        to->push_back(
            static_cast<float>((double{gap} / unit + layer.beside) * layer.range / layer.texel_world));
    all.gaps.lit_left_out += tried.gaps.lit_left_out, all.gaps.ties += tried.gaps.ties;
    all.outside += tried.outside, all.outside_wrong += tried.outside_wrong;
    all.outside_ties += tried.outside_ties;
  }
  std::sort(all.gaps.lit.begin(), all.gaps.lit.end());
  std::sort(all.gaps.shadowed.begin(), all.gaps.shadowed.end());
  const BiasRange range = smallest_good_range(all.gaps);
  const double texels = short_number_in(range.from, range.to), instead = all.wrong_at(texels);
  if (!(instead < worth_changing * least)) return std::nullopt;
  std::vector<AdvisedSetting> settings;
  for (const LayerConstant& layer : layers)
    settings.push_back(
        layer.instead(record.bias_constant_world / unit, texels * layer.texel_world / layer.range));
  Advice out = of_layers(settings, wrong_now, instead);
  out.texels_of_each = texels;
  return out;
}

std::optional<Advice> advise_on_layers(const LightComparison& light, const raster::LightRecord& record,
                                       double wrong_now, double least) {
  if (!has_layers(record)) return std::nullopt;
  const double unit = record.captured->test->unit_world, first = record.bias_constant_world / unit;
  std::vector<AdvisedSetting> settings;
  double wrong = 0.0, pixels = 0.0;
  for (int face = 0; face < record.map.view.face_count; ++face) {
    const TriedConstants tried = try_constants(record, light, face);
    const GoodConstant best = good_constant(tried, unit, first);
    wrong += best.wrong * tried.pixels(), pixels += tried.pixels();
    const LayerConstant layer(record, face);
    settings.push_back(layer.instead(first, best.stored + layer.beside));
  }
  const double instead = wrong / std::max(1.0, pixels);
  if (!(instead < worth_changing * least)) return std::nullopt;
  return of_layers(settings, wrong_now, instead);
}

namespace {

/// The filter's average over a square of texels, with any constant, of some of the pixels.
class FilteredTest {
 public:
  FilteredTest(const FrameInput& in, const raster::RasterFrame& drawn, const LightComparison& light);
  /// Mean of |average - truth|.
  double mean_error(double constant_world) const;
  bool empty() const { return pixels_.empty(); }

 private:
  struct Tap {
    double gap = 0.0, weight = 0.0;
  };
  struct Pixel {
    std::vector<Tap> taps;
    double truth = 0.0;
  };
  std::vector<Pixel> pixels_;
};

FilteredTest::FilteredTest(const FrameInput& in, const raster::RasterFrame& drawn,
                           const LightComparison& light) {
  constexpr std::size_t most = 20000;
  const raster::LightRecord& record = drawn.lights.front();
  const raster::MapOptions& map = drawn.options.map;
  const Light& source = in.world.scene->lights[record.light];
  const double radius = map.filter.radius_texels, size = record.map.view.size;
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i)
    if (is_compared(light.labels.data[i]) && record.outside_map.data[i] == 0) asked.push_back(i);
  const std::size_t step = std::max<std::size_t>(1, asked.size() / most);
  pixels_.resize(asked.size() / step);
  parallel_for(pixels_.size(), [&](std::size_t k) {
    const std::size_t i = asked[k * step];
    const raytrace::SurfacePoint& point = in.traced.receiver.data[i];
    pixels_[k].truth = double{light.rungs[0].data[i]};
    const auto lookup = biased_lookup(record, map.bias, light_at(source, point.position).to_light, point, i);
    if (!lookup) return;
    const double u = lookup->at.u, v = lookup->at.v;
    const auto part = [radius](double middle, int texel) {
      return std::min(middle + radius, texel + 1.0) - std::max(middle - radius, double(texel));
    };
    for (int row = std::max(0, int(v - radius)); row <= std::min(int(size) - 1, int(v + radius)); ++row)
      for (int column = std::max(0, int(u - radius)); column <= std::min(int(size) - 1, int(u + radius));
           ++column) {
        BiasedLookup there = *lookup;
        there.key = raytrace::TexelKey::pack(lookup->at.face, column, row);
        const auto depth = stored_caster(record, there.key);
        const double gap = depth ? gap_before(record, map.bias, point.normal, there, *depth) : -infinity;
        pixels_[k].taps.push_back({gap, part(u, column) * part(v, row)});
      }
  });
}

double FilteredTest::mean_error(double constant_world) const {
  double sum = 0.0;
  for (const Pixel& pixel : pixels_) {
    double lit = 0.0, all = 0.0;
    for (const Tap& tap : pixel.taps) all += tap.weight, lit += tap.gap <= constant_world ? tap.weight : 0.0;
    sum += std::abs((all > 0.0 ? lit / all : 1.0) - pixel.truth);
  }
  return sum / std::max<double>(1.0, double(pixels_.size()));
}

}  // namespace

void weigh_mean_error(const FrameInput& in, const raster::RasterFrame& drawn, const LightComparison& light,
                      Advice& advice) {
  constexpr int steps = 8;
  const raster::LightRecord& record = drawn.lights.front();
  if (drawn.options.map.technique != raster::Technique::pcf || !advice.layers.empty()) return;
  const FilteredTest filtered(in, drawn, light);
  if (filtered.empty()) return;
  const double unit = record.captured->test->unit_world, now = advice.now, best = advice.instead;
  advice.mean_now = filtered.mean_error(now * unit), advice.mean_instead = filtered.mean_error(best * unit);
  if (!(*advice.mean_instead > *advice.mean_now)) return;
  for (int step = steps - 1; step >= 0; --step) {
    const double constant = now + (best - now) * step / steps, mean = filtered.mean_error(constant * unit);
    if (mean >= *advice.mean_instead) continue;
    advice.instead = constant, advice.mean_instead = mean;
  }
  const TriedConstants tried = try_constants(record, light);
  advice.wrong_instead = tried.wrong_at(advice.instead * unit), advice.feasible = advice.wrong_instead == 0.0;
}

}  // namespace gnomon::compare
