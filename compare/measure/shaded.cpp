#include "compare/measure/shaded.h"

#include <algorithm>
#include <cmath>

#include "compare/metrics/flip.h"
#include "scene/base/stages.h"

namespace gnomon::compare {
namespace {

/// Half a step of eight bits: colours so near are one on every screen, and the two renderers' rounding lies far below.
constexpr float same_colour = 0.5f / 255.0f;

bool rays_draw_more(const EffectPlan& plan) {
  return plan.simulates(Effect::reflection) || plan.simulates(Effect::refraction) ||
         plan.simulates(Effect::glossy) || plan.simulates(Effect::indirect_light);
}

Vec3f shown(const Vec3f& radiance, double exposure) {
  return glm::clamp(radiance * static_cast<float>(exposure), Vec3f(0.0f), Vec3f(1.0f));
}

/// The transfer function of IEC 61966-2-1.
double encoded(float linear) {
  return linear <= 0.0031308f ? 12.92 * double{linear} : 1.055 * std::pow(double{linear}, 1.0 / 2.4) - 0.055;
}

double distance(const Vec3f& a, const Vec3f& b) {
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) sum += std::abs(encoded(a[k]) - encoded(b[k]));
  return sum / 3.0;
}

/// On silhouettes the two see different surfaces, which is no error of a shadow.
bool is_silhouette(const Comparison& c, std::size_t pixel) {
  return std::any_of(c.lights.begin(), c.lights.end(), [&](const LightComparison& light) {
    return light.labels.data[pixel] == Label::silhouette;
  });
}

}  // namespace

std::optional<ShadedError> shaded_error(const Comparison& c) {
  const ColorImage &drawn = c.raster.color, &traced = c.raytraced.color;
  if (drawn.data.empty() || !(drawn.size == traced.size) || c.judged || rays_draw_more(c.plan)) return {};
  for (const LightComparison& light : c.lights)
    if (!(light.labels.size == drawn.size)) return {};
  const TimedStage stage("metrics");
  ColorImage reference = traced, test = traced;
  double sum = 0.0;
  std::uint64_t pixels = 0;
  for (std::size_t i = 0; i < drawn.data.size(); ++i) {
    reference.data[i] = test.data[i] = shown(traced.data[i], c.exposure);
    if (is_silhouette(c, i)) continue;
    ++pixels;
    const Vec3f seen = shown(drawn.data[i], c.exposure), off = glm::abs(seen - reference.data[i]);
    if (std::max({off.x, off.y, off.z}) <= same_colour) continue;
    sum += distance(seen, reference.data[i]);
    test.data[i] = seen;
  }
  if (pixels == 0) return {};
  return ShadedError{.mean_absolute = sum / static_cast<double>(pixels), .flip = mean_flip(reference, test)};
}

}  // namespace gnomon::compare
