#include "judge/own_test.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/budget.h"
#include "judge/outside_map.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

constexpr std::size_t most_tried = 40000;
constexpr double least_believed = 0.95;
constexpr double of_shadows = 0.3;     ///< of what either shadows may differ: thin shadows are all border
constexpr std::size_t few_tried = 50;  ///< samples that tell nothing
constexpr float one_value = 0.02f;     ///< five steps of eight bits
constexpr double most_of_it = 0.5;     ///< of the shadow has that value
constexpr double darkest_share = 0.1;  ///< of the values, from which it is taken
constexpr int reach_steps = 2;         ///< on each side of the middle, over a filter's reach

constexpr double near_mean = 0.35;  ///< sixteen taps are off the mean over their reach by 1/8 (one deviation)

class OwnTester {
 public:
  OwnTester(const FrameInput& in, const raster::RasterFrame& drawn)
      : in_(in), drawn_(drawn), record_(drawn.lights.front()), light_(in.world.scene->lights[record_.light]) {
    const bool once = drawn.options.map.technique == raster::Technique::hard ||
                      captured_test(record_).reads() != CapturedTest::Reads::texel;
    reach_ = once ? 0.0 : std::max(1.0, drawn.options.map.filter.radius_texels);
  }

  /// The share of the texels within reach that are lit; none of what the test says nothing of.
  std::optional<double> at(std::size_t pixel) const {
    const raytrace::SurfacePoint& point = in_.traced.receiver.data[pixel];
    if (point.primitive == no_id || drawn_.primitive.data[pixel] != point.primitive) return std::nullopt;
    if (record_.outside_map.data[pixel] != 0 || light_cannot_reach(light_, point.position, point.normal) ||
        lies_behind_far_plane(record_, point.position, pixel))
      return std::nullopt;
    const raster::Bias& bias = drawn_.options.map.bias;
    const Vec3 to_light = light_at(light_, point.position).to_light;
    const auto lookup = compare::biased_lookup(record_, bias, to_light, point, pixel);
    if (!lookup) return std::nullopt;
    int lit = 0;
    const int side = reach_ > 0.0 ? reach_steps : 0;
    for (int j = -side; j <= side; ++j)
      for (int i = -side; i <= side; ++i)
        lit += is_dark(*lookup, bias, point.normal, reach_ / reach_steps * Vec2(i, j)) ? 0 : 1;
    return double(lit) / ((2 * side + 1) * (2 * side + 1));
  }

 private:
  bool is_dark(const compare::BiasedLookup& lookup, const raster::Bias& bias, const Vec3& normal,
               const Vec2& off) const {
    compare::BiasedLookup there = lookup;
    const int last = record_.map.view.size - 1;
    const auto texel = [last](double place) {
      return std::clamp(static_cast<int>(std::floor(place)), 0, last);
    };
    if (off != Vec2(0.0))
      there.key =
          raytrace::TexelKey::pack(lookup.at.face, texel(lookup.at.u + off.x), texel(lookup.at.v + off.y));
    const auto depth = off == Vec2(0.0) ? compare::compared_caster(record_, there)
                                        : compare::stored_caster(record_, there.key);
    return depth && compare::gap_before(record_, bias, normal, there, *depth) > record_.bias_constant_world;
  }

  const FrameInput& in_;
  const raster::RasterFrame& drawn_;
  const raster::LightRecord& record_;
  const Light& light_;
  double reach_ = 0.0;  // texels
};

/// The value of the darkest tenth, where most of the shadow has it.
double full_shadow_of(std::vector<float> values) {
  if (values.size() < few_tried) return 0.0;
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(darkest_share * double(values.size()));
  std::nth_element(values.begin(), low, values.end());
  const float value = *low;
  const auto same =
      std::count_if(values.begin(), values.end(), [&](float v) { return std::abs(v - value) <= one_value; });
  const bool is_level = value > one_value && value < 1.0f - one_value;
  return is_level && double(same) >= most_of_it * double(values.size()) ? double{value} : 0.0;
}

}  // namespace

bool OwnTestCount::is_believed() const {
  const std::size_t differ = pixels - as_drawn;
  if (pixels < few_tried || double(as_drawn) < least_believed * double(pixels)) return false;
  return differ < few_tried || double(differ) <= of_shadows * double(std::max(dark, drawn_dark));
}

OwnTest try_own_test(const FrameInput& in, const raster::RasterFrame& drawn) {
  const TimedStage stage("alignment");
  const OwnTester tester(in, drawn);
  const Image<float>& picture = drawn.lights.front().visibility;
  const std::size_t step = std::max<std::size_t>(1, picture.data.size() / most_tried);
  std::vector<std::optional<double>> said(picture.data.size() / step);
  parallel_for(said.size(), [&](std::size_t i) { said[i] = tester.at(i * step); });
  std::vector<float> in_shadow, all;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (said[i]) all.push_back(picture.data[i * step]);
    if (said[i] == 0.0) in_shadow.push_back(picture.data[i * step]);
  }
  OwnTest out;
  out.full_shadow = full_shadow_of(std::move(in_shadow)), out.darkest = full_shadow_of(std::move(all));
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (!said[i]) continue;
    const double drawn = (double{picture.data[i * step]} - out.full_shadow) / (1.0 - out.full_shadow);
    const bool is_clear = *said[i] == 0.0 || *said[i] == 1.0, drawn_dark = drawn < 0.5;
    const bool same = is_clear ? drawn_dark == (*said[i] == 0.0) : std::abs(drawn - *said[i]) <= near_mean;
    const auto count = [&](OwnTestCount& to) {
      ++to.pixels, to.as_drawn += same ? 1 : 0, to.drawn_dark += drawn_dark ? 1 : 0;
      to.dark += *said[i] < 0.5 ? 1 : 0;
    };
    count(out.all);
    if (is_clear) count(out.clear);
  }
  return out;
}

void stretch_to_full_shadow(double full_shadow, Image<float>& visibility) {
  for (float& v : visibility.data)
    v = static_cast<float>(std::clamp((double{v} - full_shadow) / (1.0 - full_shadow), 0.0, 1.0));
}

std::vector<std::string> no_shadow_notes(const compare::LightComparison& light,
                                         const raster::LightRecord& record) {
  std::size_t shadowed = 0, dark = 0;
  double most = -infinity;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i]) || record.outside_map.data[i] != 0) continue;
    dark += light.rungs[6].data[i] < 0.5f || light.rungs[5].data[i] < 0.5f ? 1 : 0;
    if (!(light.rungs[0].data[i] < 0.5f)) continue;
    ++shadowed;
    if (std::isfinite(record.gap.data[i])) most = std::max(most, double{record.gap.data[i]});
  }
  if (shadowed < few_tried || dark > 0 || !(most > 0.0)) return {};
  return {fmt::format(
      "no shadow is drawn: the bias of {:.3g} world units is more than any shadowed place lies behind what "
      "the map stores, {:.3g} at most",
      record.bias_constant_world, most)};
}

}  // namespace gnomon::judge
