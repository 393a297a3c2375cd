// The light's own irradiance on a surface of albedo a is e, other light r, both as multiples of the light's greatest. Then
// the picture without shadows shows a (r + e). That with them shows a (r + v e). Where v = 0 the two give r = e s / (u - s),
// whatever a is: one number for all surfaces that see the same other light. Its most frequent value over pixels that differ is
// that of full shadow, since penumbrae and filters spread theirs. Other light differs from side to side (a sky above, a ground
// below), so that surfaces of one orientation are asked by themselves where they are many.
#include "judge/other_light.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/result/number_text.h"
#include "judge/evidence.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::judge {
namespace {

using compare::OtherLight;

using raytrace::SurfacePoint;

/// A share of the brightest value: below it a pixel is dark, and no noise of eight bits or JPEG lies above it.
constexpr float dark_share = 0.02f;
constexpr std::size_t few_differ = 50;
/// A pixel differs by a fiftieth, or by twice what 19 of 20 pixels that cannot differ do.
constexpr double least_drop = 0.02;
constexpr std::size_t most_in_a_fit = 20000;
/// Visibilities up to this count as full shadow; half of the step to a comparison of 2 x 2 with one lit.
constexpr double full_shadow_up_to = 0.125;
/// Of the pixels that differ so many are in full shadow, or how dark that is remains unknown.
constexpr double least_agree = 0.5, least_agree_alone = 0.6;
/// The width of the window, a natural logarithm, in which values count as one: a tenth to either side.
constexpr double mode_window = 0.2;
constexpr double least_log = -9.0;  ///< e to the power of it: no other light
/// Another curve or grouping is taken where it makes so many more of the pixels agree.
constexpr double clearly_more = 0.03;

float light_sum(const Vec3f& c) {
  return c.x + c.y + c.z;
}

struct ToneCurve {
  const char* name;
  float (*decode)(float);  ///< stored to linear
};
float after_reinhard(float v) {
  const float y = std::min(linear_from_srgb(v), 0.995f);
  return y / (1.0f - y);
}
/// Inverts K. Narkowicz's fit of ACES (2016), x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14).
float after_aces(float v) {
  const float y = std::min(linear_from_srgb(v), 0.995f);
  const float a = 2.51f - 2.43f * y, b = 0.03f - 0.59f * y, c = -0.14f * y;
  return (-b + std::sqrt(std::max(0.0f, b * b - 4.0f * a * c))) / (2.0f * a);
}
constexpr ToneCurve as_linear{"linear numbers", [](float v) { return v; }};
constexpr ToneCurve as_srgb{"sRGB", linear_from_srgb};
constexpr ToneCurve as_reinhard{"sRGB after Reinhard's tone curve", after_reinhard};
constexpr ToneCurve as_aces{"sRGB after the ACES tone curve", after_aces};

Vec3f decoded_by(const ToneCurve& curve, const Vec3f& c) {
  return {curve.decode(std::max(0.0f, c.x)), curve.decode(std::max(0.0f, c.y)),
          curve.decode(std::max(0.0f, c.z))};
}

/// A pixel whose surface the light reaches.
struct LitPixel {
  std::size_t pixel;
  double light;              ///< irradiance, as a share of the brightest
  std::array<int, 3> group;  ///< by FitGroups
};

/// Surfaces of one orientation; places with as much of the light; surfaces of one orientation that look as bright. The last
/// hold where the other light does not take the surface's colour: haze, or a tone curve that no candidate is.
enum class FitGroups : std::uint8_t { sides, levels, shades };

int group_of(const LitPixel& place, FitGroups grouping) {
  return place.group[static_cast<std::size_t>(grouping)];
}

/// Four steps for each doubling.
int level_of(double value) {
  return static_cast<int>(std::lround(4.0 * std::log2(std::max(1e-9, value))));
}

int side_of(const Vec3& n) {
  const auto step = [](double x) { return static_cast<int>(std::lround(2.0 * x)) + 2; };
  return step(n.x) + 5 * (step(n.y) + 5 * step(n.z));
}

/// The middle of the window of the sorted values that holds most of them.
double mode_of(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  std::size_t best = 0, best_end = 0, end = 0;
  for (std::size_t begin = 0; begin < values.size(); ++begin) {
    while (end < values.size() && values[end] <= values[begin] + mode_window) ++end;
    if (end - begin > best_end - best) best = begin, best_end = end;
  }
  return values[best + (best_end - best) / 2];
}

class OtherLightFit {
 public:
  OtherLightFit(const CapturedPictures& pictures, const std::vector<LitPixel>& differing,
                const ToneCurve& curve, FitGroups grouping)
      : pictures_(pictures), curve_(curve), grouping_(grouping) {
    for (int channel = 0; channel < 3; ++channel) find_modes(differing, channel);
    std::size_t dark_ones = 0;
    for (const LitPixel& place : differing)
      dark_ones += std::abs(visibility(place)) <= full_shadow_up_to ? 1 : 0;
    agree_ = static_cast<double>(dark_ones) / static_cast<double>(std::max<std::size_t>(1, differing.size()));
  }

  double agree() const { return agree_; }
  const ToneCurve& curve() const { return curve_; }
  /// The share of the pixel's light that a full shadow takes.
  double taken(const LitPixel& place) const {
    const Vec3f u = unshadowed(place);
    return part_of_light(place, u) / std::max(1e-9, double{light_sum(u)});
  }
  /// Below 0 where it is darker than full shadow.
  double visibility(const LitPixel& place) const {
    const Vec3f u = unshadowed(place);
    const double part = part_of_light(place, u);
    if (!(part > 0.0)) return 1.0;
    return 1.0 - (double{light_sum(u)} - double{light_sum(shadowed(place))}) / part;
  }

 private:
  Vec3f unshadowed(const LitPixel& p) const { return decoded_by(curve_, pictures_.unshadowed.data[p.pixel]); }
  Vec3f shadowed(const LitPixel& p) const { return decoded_by(curve_, pictures_.color.data[p.pixel]); }

  void find_modes(const std::vector<LitPixel>& differing, int channel) {
    std::map<int, std::vector<double>> groups;
    std::vector<double> all;
    for (const LitPixel& place : differing) {
      const double u = unshadowed(place)[channel], s = shadowed(place)[channel];
      if (!(u - s > least_drop * u)) continue;
      const double value = std::max(least_log, std::log(std::max(1e-6, place.light * s / (u - s))));
      groups[group_of(place, grouping_)].push_back(value), all.push_back(value);
    }
    auto& other = other_[static_cast<std::size_t>(channel)];
    other.of_all = all.empty() ? infinity : std::exp(mode_of(all));
    for (auto& [group, values] : groups)
      if (values.size() >= few_differ) other.of_group[group] = std::exp(mode_of(values));
  }

  double part_of_light(const LitPixel& place, const Vec3f& u) const {
    double part = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
      const auto& other = other_[static_cast<std::size_t>(channel)];
      const auto own = other.of_group.find(group_of(place, grouping_));
      const double r = own != other.of_group.end() ? own->second : other.of_all;
      part += double{u[channel]} * place.light / (r + place.light);
    }
    return part;
  }

  struct Other {
    double of_all = infinity;
    std::map<int, double> of_group;
  };
  const CapturedPictures& pictures_;
  const ToneCurve& curve_;
  FitGroups grouping_;
  std::array<Other, 3> other_;
  double agree_ = 0.0;
};

double drop_at(const CapturedPictures& pictures, std::size_t i) {
  const double u = light_sum(pictures.unshadowed.data[i]), s = light_sum(pictures.color.data[i]);
  return u > 0.0 ? (u - s) / u : 0.0;
}

float brightest_sum(const ColorImage& picture) {
  float brightest = 0.0f;
  for (const Vec3f& c : picture.data) brightest = std::max(brightest, light_sum(c));
  return brightest;
}

bool reaches(const SurfacePoint& point, const Light& light) {
  return point.primitive != no_id && !light_cannot_reach(light, point.position, point.normal);
}

std::vector<LitPixel> lit_pixels(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame,
                                 const Light& light) {
  constexpr int sides = 125;
  std::vector<LitPixel> out;
  double brightest = 0.0;
  for (std::size_t i = 0; i < frame.receiver.data.size(); ++i) {
    const SurfacePoint& point = frame.receiver.data[i];
    if (!reaches(point, light)) continue;
    const int side = side_of(point.normal);
    const int shade = level_of(double{light_sum(pictures.unshadowed.data[i])});
    out.push_back({i, light_on(light, point), {side, 0, side + sides * shade}});
    brightest = std::max(brightest, out.back().light);
  }
  for (LitPixel& place : out) {
    place.light /= std::max(1e-300, brightest);
    place.group[static_cast<std::size_t>(FitGroups::levels)] = level_of(place.light);
  }
  return out;
}

/// By how much each pixel differs that no shadow of the light can change.
std::vector<double> other_drops(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame,
                                const Light& light) {
  std::vector<double> drops;
  for (std::size_t i = 0; i < frame.receiver.data.size(); ++i)
    if (!reaches(frame.receiver.data[i], light) && pictures.reached.data[i] != 0)
      drops.push_back(std::abs(drop_at(pictures, i)));
  return drops;
}

/// What 19 of 20 of them differ by.
double noise_of(std::vector<double> drops) {
  if (drops.size() < few_differ) return 0.0;
  const auto at = drops.begin() + static_cast<std::ptrdiff_t>(drops.size() * 19 / 20);
  std::nth_element(drops.begin(), at, drops.end());
  return *at;
}

std::vector<LitPixel> thinned(const std::vector<LitPixel>& all) {
  if (all.size() <= most_in_a_fit) return all;
  std::vector<LitPixel> out;
  for (std::size_t i = 0; i < most_in_a_fit; ++i) out.push_back(all[i * all.size() / most_in_a_fit]);
  return out;
}

OtherLightFit best_fit(const CapturedPictures& pictures, const std::vector<LitPixel>& differing) {
  const std::array<const ToneCurve*, 4> curves =
      pictures.eight_bits ? std::array{&as_srgb, &as_linear, &as_reinhard, &as_aces}
                          : std::array{&as_linear, &as_srgb, &as_reinhard, &as_aces};
  const std::vector<LitPixel> some = thinned(differing);
  std::optional<OtherLightFit> best;
  for (const FitGroups grouping : {FitGroups::sides, FitGroups::levels, FitGroups::shades})
    for (const ToneCurve* curve : curves) {
      OtherLightFit fit(pictures, some, *curve, grouping);
      if (!best || fit.agree() > best->agree() + clearly_more) best.emplace(std::move(fit));
    }
  return std::move(*best);
}

OtherLight describe_fit(const OtherLightFit& fit, const std::vector<LitPixel>& differing) {
  std::vector<double> taken;
  for (const LitPixel& place : differing) taken.push_back(fit.taken(place));
  const auto middle = taken.begin() + static_cast<std::ptrdiff_t>(taken.size() / 2);
  std::nth_element(taken.begin(), middle, taken.end());
  return {*middle, differing.size(), fit.agree(), fit.curve().name};
}

void write_visibility(const OtherLightFit& fit, const std::vector<LitPixel>& places, double noise,
                      CapturedPictures& pictures) {
  std::fill(pictures.visibility.data.begin(), pictures.visibility.data.end(), 1.0f);
  for (const LitPixel& place : places) {
    if (fit.taken(place) < 2.0 * noise)
      pictures.reached.data[place.pixel] = 0;  // too little to tell
    else
      pictures.visibility.data[place.pixel] = static_cast<float>(std::clamp(fit.visibility(place), 0.0, 1.0));
  }
  for (ColorImage* picture : {&pictures.color, &pictures.unshadowed})
    for (Vec3f& c : picture->data) c = decoded_by(fit.curve(), c);
}

}  // namespace

bool holds_other_light(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame,
                       const Light& light) {
  const float least = dark_share * brightest_sum(pictures.unshadowed);
  std::size_t background = 0, away = 0, dark_ones = 0, differ = 0, black = 0;
  for (std::size_t i = 0; i < frame.receiver.data.size(); ++i) {
    const SurfacePoint& point = frame.receiver.data[i];
    background += point.primitive == no_id ? 1 : 0;
    away += point.primitive != no_id && !reaches(point, light) ? 1 : 0;
    dark_ones += light_sum(pictures.unshadowed.data[i]) <= least ? 1 : 0;
    const double drop = drop_at(pictures, i);
    differ += drop > 0.1 ? 1 : 0, black += drop > 0.95 ? 1 : 0;
  }
  if (background + away < few_differ) return differ >= few_differ && 50 * black < differ;
  if (2 * dark_ones < background + away) return true;
  return away >= few_differ && 2 * dark_ones < 2 * background + away;
}

Expected<std::optional<OtherLight>> undo_other_light(const Capture& capture, const Light& light,
                                                     const raytrace::RayTracedFrame& frame,
                                                     CapturedPictures& pictures) {
  const std::vector<LitPixel> places = lit_pixels(pictures, frame, light);
  const std::vector<double> others = other_drops(pictures, frame, light);
  const bool alone =
      others.size() < few_differ;  // nothing but the differing pixels themselves tells of other light
  const double noise = std::max(0.5 * least_drop, noise_of(others));
  std::vector<LitPixel> differing;
  for (const LitPixel& place : places)
    if (drop_at(pictures, place.pixel) > 2.0 * noise) differing.push_back(place);
  if (differing.size() < few_differ) {
    if (alone) return std::optional<OtherLight>();
    std::fill(pictures.visibility.data.begin(), pictures.visibility.data.end(), 1.0f);
    return std::optional<OtherLight>();
  }
  const OtherLightFit fit = best_fit(pictures, differing);
  const OtherLight found = describe_fit(fit, differing);
  if (alone && found.agree < least_agree_alone) return std::optional<OtherLight>();
  if (found.agree < least_agree)
    return capture_error(
        capture, "",
        fmt::format(
            "both pictures hold other light (ambient light, a sky), and how dark a full shadow is does "
            "not show: of the {} pixels that differ only {} agree on it; draw this light alone, or "
            "give its `strength`",
            compare::grouped(found.pixels), compare::percent(found.agree)));
  write_visibility(fit, places, noise, pictures);
  divide_by_also(pictures);
  return std::optional(found);
}

std::vector<std::string> other_light_notes(const OtherLight& found) {
  const bool assumed =
      found.read_as == std::string_view(as_srgb.name) || found.read_as == std::string_view(as_linear.name);
  return {fmt::format(
              "both pictures hold other light (ambient light, a sky): a full shadow takes {} of a pixel's "
              "light, not all of it, and visibilities count from there",
              compare::percent(found.full_shadow)),
          fmt::format(
              "that share is found from the {} pixels that differ, {} of them in full shadow; the numbers "
              "are read as {}{}",
              compare::grouped(found.pixels), compare::percent(found.agree), found.read_as,
              assumed ? ", which matters to greys alone" : ", which fits best")};
}

}  // namespace gnomon::judge
