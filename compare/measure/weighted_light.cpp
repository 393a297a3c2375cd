#include "compare/measure/weighted_light.h"

#include <cmath>
#include <limits>

#include "raytrace/shading/light_samples.h"
#include "raytrace/shading/picture.h"

namespace gnomon::compare {
namespace {

using raytrace::SurfacePoint;

/// The normal of a light that is sampled by its area; none of one that is sampled by the solid angle that it fills.
std::optional<Vec3> light_normal(const Light& light) {
  if (const auto* disc = std::get_if<DiscLight>(&light.extent)) return glm::normalize(disc->normal);
  if (const auto* rectangle = std::get_if<RectangleLight>(&light.extent))
    return glm::normalize(glm::cross(rectangle->half_width, rectangle->half_height));
  return std::nullopt;
}

double weight_of(const Ray& ray, const SurfacePoint& from, const std::optional<Vec3>& light_normal) {
  const double cosine = std::max(0.0, glm::dot(from.normal, ray.direction));
  return light_normal ? cosine * std::abs(glm::dot(*light_normal, ray.direction)) / (ray.t.max * ray.t.max)
                      : cosine;
}

/// |W - V0| at one receiver.
double difference_at(const raytrace::Tracer& tracer, const Light& light, int samples,
                     const SurfacePoint& from, std::uint64_t key) {
  const raytrace::LightSamples rays(tracer, from, light, samples, key);
  const std::optional<Vec3> normal = light_normal(light);
  double arrived = 0.0, all = 0.0, seen = 0.0;
  for (int i = 0; i < rays.count(); ++i) {
    const std::optional<Ray> ray = rays[i];
    if (!ray) continue;
    const double weight = weight_of(*ray, from, normal);
    const bool lit = !tracer.occluded(*ray);
    all += weight, arrived += lit ? weight : 0.0, seen += lit ? 1.0 : 0.0;
  }
  return all > 0.0 ? std::abs(arrived / all - seen / rays.count()) : 0.0;
}

}  // namespace

void WeightedLight::add(const raytrace::Tracer& tracer, const Light& light, int samples,
                        const Image<SurfacePoint>& receivers, const Image<float>& truth,
                        const Image<Label>& labels, std::size_t first_pixel, std::size_t all_pixels) {
  constexpr std::size_t about = 4096;  // pixels that are looked at
  const std::size_t step = std::max<std::size_t>(1, all_pixels / about);
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    const std::size_t pixel = first_pixel + i;
    if (pixel % step != step / 2 || !is_compared(labels.data[i])) continue;
    if (!(truth.data[i] > 0.0f && truth.data[i] < 1.0f)) continue;
    sum_ += difference_at(tracer, light, samples, receivers.data[i], raytrace::pixel_key(0, pixel, 0));
    ++receivers_;
  }
}

void WeightedLight::write_to(PenumbraStats& out) const {
  out.weighted_difference =
      receivers_ > 0 ? sum_ / static_cast<double>(receivers_) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace gnomon::compare
