#include "studies/judge/described_test.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "compare/truth/columns.h"
#include "compare/truth/stored_surface.h"
#include "scene/stages.h"
#include "studies/judge/identify.h"

namespace gnomon::compare {
namespace {

using raytrace::SurfacePoint;

/// A renderer's floats place a receiver that far from where doubles do; and the last bits of a depth between 1/2 and 1,
/// with those of the matrix that made it.
constexpr double rounding_texels = 0.02, rounding_stored = 0x1p-22;
/// Pixels whose drawing the description does not explain, of which nothing is said: a share, and a number.
constexpr double few_share = 1e-3;
constexpr std::size_t few_pixels = 10;
/// Of the map's own precision, taken from how far half of its texels are off: no more than that of stored numbers, and
/// so many times it.
constexpr double most_imprecise = 0.01, times_median = 8.0;
/// Multiples of what the surface's depth changes by over half a texel along both axes: polygon offsets, other sample
/// places.
constexpr double slopes_allowed = 4.0;

class Checker {
 public:
  Checker(const FrameInput& in, const raster::RasterFrame& drawn)
      : in_(in),
        map_(drawn.options.map),
        record_(drawn.lights.front()),
        light_(in.world.scene->lights[record_.light]),
        slack_(record_.rounding_world + rounding_stored * record_.captured->test->unit_world) {
    using raster::Technique;
    const bool compares = map_.technique == Technique::pcf || map_.technique == Technique::pcss || is_hard();
    reach_ = compares ? rounding_texels + (is_hard() ? 0.0 : map_.filter.radius_texels) : infinity;
  }

  bool may_draw(std::size_t pixel, float visibility, bool any_cascade) const;
  void measure_precision(const Image<Label>& labels);
  bool holds_other(std::size_t pixel) const;

 private:
  bool is_hard() const { return map_.technique == raster::Technique::hard; }
  std::optional<BiasedLookup> lookup_of(std::size_t pixel) const {
    const SurfacePoint& receiver = in_.traced.receiver.data[pixel];
    return biased_lookup(record_, map_.bias, light_at(light_, receiver.position).to_light, receiver, pixel);
  }
  bool some_texel_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit) const;
  struct Exact {
    double depth = 0.0;  // along the map's forward axis
    double slope = 0.0;  // what it changes by over half a texel along both axes, world units
  };
  std::optional<Exact> exact_depth(raytrace::TexelKey key) const;
  double off(raytrace::TexelKey key, double stored, double slopes) const;

  const FrameInput& in_;
  const raster::MapOptions& map_;
  const raster::LightRecord& record_;
  const Light& light_;
  double slack_;  // world units
  double reach_ = 0.0;
  double imprecise_ = 0.0;  // of stored numbers
};

/// What lies beyond the map's border is the renderer's own choice.
bool Checker::some_texel_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit) const {
  const auto texel = [](double place) { return static_cast<int>(std::floor(place)); };
  const int left = texel(lookup.at.u - reach_), right = texel(lookup.at.u + reach_);
  const int low = texel(lookup.at.v - reach_), high = texel(lookup.at.v + reach_);
  const int last = record_.map.view.size - 1;
  if (left < 0 || low < 0 || right > last || high > last) return true;
  for (int row = low; row <= high; ++row)
    for (int column = left; column <= right; ++column) {
      BiasedLookup there = lookup;
      there.key = raytrace::TexelKey::pack(lookup.at.face, column, row);
      const auto depth = stored_caster(record_, there.key);
      const double gap = depth ? gap_before(record_, map_.bias, normal, there, *depth) : -infinity;
      const double over = gap - record_.bias_constant_world;
      if (lit ? over <= slack_ : over > -slack_) return true;
    }
  return false;
}

bool Checker::may_draw(std::size_t pixel, float visibility, bool any_cascade) const {
  if (std::isinf(reach_)) return true;
  auto lookup = lookup_of(pixel);
  if (!lookup) return true;
  const Vec3& normal = in_.traced.receiver.data[pixel].normal;
  const bool lit = visibility > 0.5f;
  if (some_texel_draws(*lookup, normal, lit)) return true;
  const LightView& view = record_.map.view;
  if (!any_cascade || view.projection != LightProjection::orthographic) return false;
  for (int face = 0; face < view.face_count; ++face) {
    lookup->at = project_to_face(view, face, lookup->position);
    if (lookup->at.inside && some_texel_draws(*lookup, normal, lit)) return true;
  }
  return false;
}

/// Of what the light meets first at the texel's centre, or, of a map of back faces, of what it stores.
std::optional<Checker::Exact> Checker::exact_depth(raytrace::TexelKey key) const {
  const LightView& view = record_.map.view;
  const Ray ray = caster_ray(view, key.face(), key.column() + 0.5, key.row() + 0.5);
  auto hit = in_.tracer.closest_hit(ray, raytrace::Sides::casting);
  if (hit && map_.cull != raster::Cull::none) {
    const StoredSurface stored = stored_surface(in_.tracer, record_, map_, key);
    if (stored.primitive != no_id) hit->primitive = stored.primitive, hit->t = stored.t;
  }
  if (!hit) return std::nullopt;
  const SurfacePoint point = in_.tracer.surface_point(ray, *hit);
  const Vec3 facing = glm::dot(point.normal, ray.direction) > 0.0 ? -point.normal : point.normal;
  const TexelCoordinate at = project_to_face(view, key.face(), point.position);
  return Exact{glm::dot(ray.at(hit->t) - view.origin, view.face(key.face()).forward),
               texel_depth_slope(view, at, point.position, facing)};
}

/// How far a stored number is off what the scene has at that texel, less so many of the surface's slopes; infinite
/// where the scene has nothing there.
double Checker::off(raytrace::TexelKey key, double stored, double slopes) const {
  const LightView& view = record_.map.view;
  const auto exact = exact_depth(key);
  if (!exact) return infinity;
  const double slack = slopes > 0.0 ? slopes * exact->slope : 0.0;
  if (std::isinf(slack)) return 0.0;
  const auto number = [&](double depth) {
    const Interval range = view.depth_range();
    return stored_from_depth(view, key.face(), key.row() + 0.5, std::clamp(depth, range.min, range.max));
  };
  const auto [low, high] = std::minmax({number(exact->depth - slack), number(exact->depth + slack)});
  return std::max({0.0, low - stored, stored - high});
}

void Checker::measure_precision(const Image<Label>& labels) {
  std::vector<double> offs;
  const std::size_t step = std::max<std::size_t>(1, labels.data.size() / 4096);
  for (std::size_t i = 0; i < labels.data.size(); i += step) {
    const auto lookup = is_compared(labels.data[i]) ? lookup_of(i) : std::nullopt;
    if (!lookup || !stored_caster(record_, lookup->key)) continue;
    const raytrace::TexelKey key = lookup->key;
    const double stored = record_.map.depth[record_.map.texel_index(key.face(), key.column(), key.row())];
    offs.push_back(off(key, stored, 0.0));
  }
  if (offs.empty()) return;
  const auto middle = offs.begin() + static_cast<std::ptrdiff_t>(offs.size() / 2);
  std::nth_element(offs.begin(), middle, offs.end());
  imprecise_ = std::min(most_imprecise, times_median * *middle);
}

/// Neither at the texel's centre nor at its neighbours' does the light first meet something at the stored depth.
bool Checker::holds_other(std::size_t pixel) const {
  const auto lookup = lookup_of(pixel);
  if (!lookup) return false;
  const LightView& view = record_.map.view;
  const raytrace::TexelKey key = lookup->key;
  const double stored = record_.map.depth[record_.map.texel_index(key.face(), key.column(), key.row())];
  const bool nothing = !holds_caster(view, stored);
  const double allowed = imprecise_ + slack_ / record_.captured->test->unit_world;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) {
      const int column = key.column() + du, row = key.row() + dv;
      if (std::min(column, row) < 0 || std::max(column, row) >= view.size) continue;
      const auto there = raytrace::TexelKey::pack(key.face(), column, row);
      const auto exact = nothing ? exact_depth(there) : std::nullopt;
      const bool beyond = !exact || !(exact->depth < view.depth_range().max);
      if (nothing ? beyond : off(there, stored, slopes_allowed) <= allowed) return false;
    }
  return true;
}

bool keeps_label(Label label) {
  return label == Label::outside_map || label == Label::light_size;
}

}  // namespace

bool DescribedTest::is_drawn() const {
  return not_drawn < few_pixels || static_cast<double>(not_drawn) < few_share * static_cast<double>(compared);
}

DescribedTest check_described_test(const FrameInput& in, const raster::RasterFrame& drawn,
                                   LightComparison& light) {
  const TimedStage stage("described test");
  Checker checker(in, drawn);
  checker.measure_precision(light.labels);
  const auto differs = [&](std::size_t i) {
    return is_compared(light.labels.data[i]) &&
           std::abs(light.rungs[5].data[i] - light.rungs[6].data[i]) > 0.5f;
  };
  const std::size_t pixels = light.labels.data.size();
  DescribedTest out;
  out.compared =
      pixels_where(pixels, [&](std::size_t i) { return is_compared(light.labels.data[i]); }).size();
  out.not_drawn = pixels_where(pixels, [&](std::size_t i) {
                    return differs(i) && !checker.may_draw(i, light.rungs[6].data[i], true);
                  }).size();
  // Where the test is another, it is chance that some texel nearby agrees with the picture.
  const bool is_drawn = out.is_drawn();
  const auto unexplained = pixels_where(pixels, [&](std::size_t i) {
    const Label label = light.labels.data[i];
    if (!is_wrong(label) || keeps_label(label)) return false;
    if (differs(i)) return !is_drawn || !checker.may_draw(i, light.rungs[6].data[i], false);
    return label == Label::precision && checker.holds_other(i);
  });
  out.other_content = static_cast<std::size_t>(
      std::count_if(unexplained.begin(), unexplained.end(), [&](std::uint32_t i) { return !differs(i); }));
  if (!unexplained.empty()) mark_unexplained(unexplained, light);
  return out;
}

std::vector<std::string> described_test_notes(const DescribedTest& test,
                                              const std::optional<OtherTest>& other) {
  std::vector<std::string> out;
  if (!test.is_drawn()) {
    std::string note = fmt::format(
        "the test as described (map, matrix, bias, filter) is not the one that was drawn in {} of {} "
        "compared pixels: the wrong ones among them are unexplained, and {}",
        grouped(test.not_drawn), grouped(test.compared),
        advice_holds(test, other) ? "advice starts from the bias as described" : "no bias is advised");
    if (other)
      note +=
          fmt::format("; if {}, it is the one drawn in {} of the pixels", other->what, percent(other->share));
    out.push_back(std::move(note));
  }
  if (test.other_content >= few_pixels)
    out.push_back(
        fmt::format("in {} wrong pixels the map does not hold what the light meets first in the scene (a "
                    "caster that is missing from the map, or moved, or in it alone): they are unexplained",
                    grouped(test.other_content)));
  return out;
}

}  // namespace gnomon::compare
