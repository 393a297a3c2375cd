#include "studies/judge/described_test.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/paraboloids.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "scene/base/stages.h"
#include "studies/judge/identify.h"

namespace gnomon::compare {
namespace {

using raytrace::SurfacePoint;

/// Pixels whose drawing the description does not explain, of which nothing is said: a share, and a number.
constexpr double few_share = 1e-3;
constexpr std::size_t few_pixels = 10;
class Checker {
 public:
  Checker(const FrameInput& in, const raster::RasterFrame& drawn)
      : in_(in),
        map_(drawn.options.map),
        record_(drawn.lights.front()),
        light_(in.world.scene->lights[record_.light]),
        slack_(record_.rounding_world + lookup_rounding_stored * record_.captured->test->unit_world),
        reads_between_(record_.captured->test->read != raster::CapturedTest::Read::nearest) {
    using raster::Technique;
    const bool compares =
        map_.technique == Technique::pcf || map_.technique == Technique::pcss || is_hard() || reads_between_;
    // Far from the origin a receiver's floats lie that far apart, in whatever a renderer works out of them.
    place_ = lookup_rounding_texels + record_.rounding.float_world / record_.texel_world;
    reach_ = compares ? place_ + (is_hard() ? 0.0 : map_.filter.radius_texels) : infinity;
  }

  bool may_draw(std::size_t pixel, float visibility, bool any_cascade) const;
  /// What an average of single comparisons over a square of texels, each as much as it lies in that, makes of a pixel; none
  /// beyond the map's border.
  std::optional<double> mean_light(std::size_t pixel, double radius_texels) const;

 private:
  bool is_hard() const { return map_.technique == raster::Technique::hard; }
  std::optional<BiasedLookup> lookup_of(std::size_t pixel) const {
    const SurfacePoint& receiver = in_.traced.receiver.data[pixel];
    return biased_lookup(record_, map_.bias, light_at(light_, receiver.position).to_light, receiver, pixel);
  }
  /// Whether the test draws it where the lookup reads this depth.
  bool draws(const BiasedLookup& lookup, const Vec3& normal, const std::optional<double>& depth,
             bool lit) const {
    const double gap = depth ? gap_before(record_, map_.bias, normal, lookup, *depth) : -infinity;
    const double over = gap - record_.bias_constant_world;
    return lit ? over <= slack_ : over > -slack_;
  }
  bool read_between_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit) const;
  bool some_texel_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit) const;

  const FrameInput& in_;
  const raster::MapOptions& map_;
  const raster::LightRecord& record_;
  const Light& light_;
  double slack_;  // world units
  bool reads_between_;
  double place_ = 0.0, reach_ = 0.0;  // texels
};

/// Whether what is read between texels draws it, at the place or as far from it as rounding goes.
bool Checker::read_between_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit) const {
  for (const Vec2& off : {Vec2(0, 0), Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
    BiasedLookup there = lookup;
    there.at.u += place_ * off.x, there.at.v += place_ * off.y;
    if (draws(lookup, normal, compared_caster(record_, there), lit)) return true;
  }
  return false;
}

/// What lies beyond the map's border is the renderer's own choice.
bool Checker::some_texel_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit) const {
  if (reads_paraboloids(record_)) {
    const auto depths = casters_around(record_, lookup, reach_);
    return std::any_of(depths.begin(), depths.end(),
                       [&](const auto& depth) { return draws(lookup, normal, depth, lit); });
  }
  if (reads_between_) return read_between_draws(lookup, normal, lit);
  const auto texel = [](double place) { return static_cast<int>(std::floor(place)); };
  const int left = texel(lookup.at.u - reach_), right = texel(lookup.at.u + reach_);
  const int low = texel(lookup.at.v - reach_), high = texel(lookup.at.v + reach_);
  const int last = record_.map.view.size - 1;
  if (left < 0 || low < 0 || right > last || high > last) return true;
  for (int row = low; row <= high; ++row)
    for (int column = left; column <= right; ++column) {
      BiasedLookup there = lookup;
      there.key = raytrace::TexelKey::pack(lookup.at.face, column, row);
      if (draws(there, normal, stored_caster(record_, there.key), lit)) return true;
    }
  return false;
}

bool Checker::may_draw(std::size_t pixel, float visibility, bool any_cascade) const {
  if (std::isinf(reach_)) return true;
  if (record_.captured->test->face_of(pixel) == raster::CapturedTest::no_face) return visibility > 0.5f;
  auto lookup = lookup_of(pixel);
  if (!lookup) return true;
  const Vec3& normal = in_.traced.receiver.data[pixel].normal;
  const bool lit = visibility > 0.5f;
  if (some_texel_draws(*lookup, normal, lit)) return true;
  const LightView& view = record_.map.view;
  const bool by_place = record_.captured->test->face_of(pixel) == raster::CapturedTest::any_face;
  if (!any_cascade || !by_place || view.projection != LightProjection::orthographic) return false;
  for (int face = 0; face < view.face_count; ++face) {
    lookup->at = project_to_face(view, face, lookup->position);
    if (lookup->at.inside && some_texel_draws(*lookup, normal, lit)) return true;
  }
  return false;
}

std::optional<double> Checker::mean_light(std::size_t pixel, double radius) const {
  const auto lookup = lookup_of(pixel);
  if (!lookup || reads_paraboloids(record_)) return std::nullopt;
  const double u = lookup->at.u, v = lookup->at.v, size = record_.map.view.size;
  if (u < radius || v < radius || u + radius >= size || v + radius >= size) return std::nullopt;
  const auto part = [radius](double middle, int texel) {
    return std::min(middle + radius, texel + 1.0) - std::max(middle - radius, double(texel));
  };
  const Vec3& normal = in_.traced.receiver.data[pixel].normal;
  double light = 0.0;
  for (int row = int(v - radius); row <= int(v + radius); ++row)
    for (int column = int(u - radius); column <= int(u + radius); ++column) {
      BiasedLookup there = *lookup;
      there.key = raytrace::TexelKey::pack(lookup->at.face, column, row);
      const auto depth = stored_caster(record_, there.key);
      const double gap = depth ? gap_before(record_, map_.bias, normal, there, *depth) : -infinity;
      if (gap <= record_.bias_constant_world) light += part(u, column) * part(v, row);
    }
  return light / (4.0 * radius * radius);
}

bool keeps_label(Label label) {
  return label == Label::outside_map || label == Label::light_size;
}

/// The radius of the average of comparisons that comes nearest to what was drawn of these pixels; 0: none comes near.
double find_filter_radius(const Checker& checker, const LightComparison& light,
                          const std::vector<std::uint32_t>& not_drawn) {
  constexpr double radii[] = {0.5, 1.0, 1.5, 2.0, 2.5, 3.5, 4.5, 5.5, 6.5, 8.5};
  constexpr double near_enough = 0.15;  // a mean difference; kernels differ in their weights
  double best = 0.0, least = near_enough;
  for (const double radius : radii) {
    double sum = 0.0, count = 0.0;
    for (const std::uint32_t i : not_drawn)
      if (const auto mean = checker.mean_light(i, radius))
        sum += std::abs(*mean - double{light.rungs[6].data[i]}), count += 1.0;
    if (count > 0.5 * double(not_drawn.size()) && sum < least * count) best = radius, least = sum / count;
  }
  return best;
}

}  // namespace

bool DescribedTest::is_drawn() const {
  return not_drawn < few_pixels || static_cast<double>(not_drawn) < few_share * static_cast<double>(compared);
}

bool DescribedTest::is_mostly_drawn() const {
  constexpr double some = 0.05;
  return static_cast<double>(not_drawn) < some * static_cast<double>(compared);
}

DescribedTest check_described_test(const FrameInput& in, const raster::RasterFrame& drawn,
                                   LightComparison& light) {
  const TimedStage stage("described test");
  const Checker checker(in, drawn);
  const auto differs = [&](std::size_t i) {
    return is_compared(light.labels.data[i]) &&
           std::abs(light.rungs[5].data[i] - light.rungs[6].data[i]) > 0.5f;
  };
  const std::size_t pixels = light.labels.data.size();
  DescribedTest out;
  out.compared =
      pixels_where(pixels, [&](std::size_t i) { return is_compared(light.labels.data[i]); }).size();
  const auto not_drawn = pixels_where(pixels, [&](std::size_t i) {
    return differs(i) && !checker.may_draw(i, light.rungs[6].data[i], true);
  });
  out.not_drawn = not_drawn.size();
  if (!out.is_drawn()) out.filter_radius = find_filter_radius(checker, light, not_drawn);
  for (const std::uint32_t i : not_drawn)
    out.drawn_darker += light.rungs[6].data[i] < light.rungs[5].data[i] ? 1 : 0;
  // Where the test is another, it is chance that some texel nearby agrees with the picture.
  const bool is_drawn = out.is_drawn();
  const auto unexplained = pixels_where(pixels, [&](std::size_t i) {
    const Label label = light.labels.data[i];
    if (!has_cause(label) || keeps_label(label)) return false;
    return differs(i) && (!is_drawn || !checker.may_draw(i, light.rungs[6].data[i], false));
  });
  if (is_drawn)
    for (const std::uint32_t i : unexplained)
      out.by_another_layer += checker.may_draw(i, light.rungs[6].data[i], true) ? 1 : 0;
  if (!unexplained.empty()) mark_unexplained(unexplained, light);
  return out;
}

std::vector<std::string> far_places_notes(const FrameInput& in, const raster::LightRecord& record) {
  constexpr double coarse_texels = 0.1;
  double farthest = 0.0;
  for (const SurfacePoint& point : in.traced.receiver.data)
    if (point.primitive != no_id)
      for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(point.position[axis]));
  const double spacing = farthest > 0.0 ? std::ldexp(1.0, std::ilogb(farthest) - 23) : 0.0;
  if (spacing < coarse_texels * record.texel_world) return {};
  return {
      fmt::format("places of 32 bits lie {} apart so far from the origin ({:.3g}), {} of the map: move the "
                  "origin nearer, or "
                  "work with places relative to the camera",
                  with_noun(fmt::format("{:.2g}", spacing), "world unit"), farthest,
                  texels_text(spacing / record.texel_world))};
}

std::vector<std::string> described_test_notes(const DescribedTest& test,
                                              const std::optional<OtherTest>& other) {
  std::vector<std::string> out;
  if (test.is_drawn() && test.by_another_layer >= few_pixels)
    out.push_back(fmt::format(
        "{} wrong pixels are drawn as another layer has them than the first that holds their place: "
        "`map[].select` of gnomon/capture/2 says by which distances layers are chosen",
        grouped(test.by_another_layer)));
  if (!test.is_drawn()) {
    std::string note = fmt::format(
        "the test as described (map, matrix, bias, filter) is not the one that was drawn in {} of {} "
        "compared pixels ({} of them darker, {} lighter): the wrong ones among them are unexplained, and {}",
        grouped(test.not_drawn), grouped(test.compared), grouped(test.drawn_darker),
        grouped(test.not_drawn - test.drawn_darker),
        !advice_holds(test, other) ? "no bias is advised"
        : other                    ? "advice starts from the bias as described"
                                   : "advice leaves them as they were drawn");
    if (other)
      note +=
          fmt::format("; if {}, it is the one drawn in {} of the pixels", other->what, percent(other->share));
    else if (test.filter_radius > 0.0)
      note += fmt::format(
          "; an average over {} to each side would draw them (`filter.kind`, `filter.radius_texels`)",
          with_noun(fmt::format("{:g}", test.filter_radius), "texel"));
    else if (test.is_mostly_drawn() && 20 * test.drawn_darker > 19 * test.not_drawn)
      note += "; what else takes light away (contact shadows, a cookie) is said by `also`";
    out.push_back(std::move(note));
  }
  return out;
}

}  // namespace gnomon::compare
