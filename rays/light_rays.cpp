#include "rays/light_rays.h"

#include <array>
#include <limits>

#include "rays/ray_samples.h"
#include "raytrace/shading/light_samples.h"
#include "raytrace/shading/picture.h"
#include "raytrace/tiles.h"
#include "scene/base/parallel.h"

namespace gnomon::rays {
namespace {

using raytrace::SurfacePoint;
using raytrace::Tracer;

/// Half of what a light of size reaches beside its centre: a sun's per world unit of distance.
double half_extent(const Light& light) {
  if (const auto* sun = std::get_if<SunDisc>(&light.extent)) return std::tan(0.5 * sun->angular_diameter);
  if (const auto* rectangle = std::get_if<RectangleLight>(&light.extent))
    return std::sqrt(glm::length(rectangle->half_width) * glm::length(rectangle->half_height));
  return light_size(light);
}

/// Makes one pixel's rays to the light.
class PixelCaster {
 public:
  PixelCaster(const Tracer& tracer, const RaysWanted& wanted, ImageSize size)
      : tracer_(tracer), wanted_(wanted), light_(tracer.world().scene->lights[wanted.light]), size_(size) {}

  std::uint32_t count() const { return raster::rays_of(wanted_.options.count); }

  /// ray(i-th ray) for each that leaves above the horizon.
  template <class OnRay>
  void each(int x, int y, const SurfacePoint& from, const OnRay& on_ray) const {
    const std::uint32_t row = wanted_.first_row + static_cast<std::uint32_t>(y);
    const std::size_t pixel = std::size_t{row} * static_cast<std::size_t>(size_.width) + std::size_t(x);
    // Other than the key of the truth's samples: an error that both share would not be seen.
    constexpr std::uint64_t few_rays = 0x66657772617973;
    const std::uint64_t key =
        raytrace::sample_key(raytrace::pixel_key(wanted_.seed, pixel, wanted_.light), few_rays);
    const RaySquare square(wanted_.options.sampler,
                           {static_cast<std::uint32_t>(x), row, wanted_.frame, count(), key});
    const LightSampler sampler = light_sampler(light_, from.position);
    for (std::uint32_t i = 0; i < count(); ++i) {
      const Vec3 aim = sampler.aim(sampler, square[i]);
      const Ray ray = light_.type == LightType::directional ? tracer_.spawn_ray(from, aim)
                                                            : tracer_.shadow_ray(from, aim);
      if (glm::dot(from.normal, ray.direction) > 0.0) on_ray(ray);
    }
  }

  double reach(const SurfacePoint& from) const { return light_at(light_, from.position).distance; }
  const Light& light() const { return light_; }

 private:
  const Tracer& tracer_;
  const RaysWanted& wanted_;
  const Light& light_;
  ImageSize size_;
};

/// Of one ray for 2 x 2 pixels: the pixel of the block that is asked this frame, in turn, or the next of the block that can be;
/// no_id where none can be.
std::uint32_t asked_of_block(const Guides& guides, int x, int y, std::uint32_t frame) {
  constexpr std::array<std::array<int, 2>, 4> turn{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
  const int left = x & ~1, top = y & ~1;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto& [dx, dy] = turn[(frame + i) % 4];
    if (left + dx >= guides.size.width || top + dy >= guides.size.height) continue;
    const std::size_t at = guides.index(left + dx, top + dy);
    if (guides.data[at].asked()) return static_cast<std::uint32_t>(at);
  }
  return no_id;
}

void cast_pixel(const Tracer& tracer, const PixelCaster& caster, int x, int y, const SurfacePoint& from,
                LightRays& out, std::uint64_t& rays) {
  int arrived = 0;
  double half_width = std::numeric_limits<double>::infinity();
  caster.each(x, y, from, [&](const Ray& ray) {
    ++rays;
    const auto hit = tracer.closest_hit(ray, raytrace::Sides::casting);
    if (!hit)
      ++arrived;
    else
      half_width = std::min(half_width, penumbra_half_width(caster.light(), caster.reach(from), hit->t));
  });
  out.share.at(x, y) = static_cast<float>(arrived) / static_cast<float>(caster.count());
  out.half_width.at(x, y) = std::isfinite(half_width) ? static_cast<float>(half_width) : 0.0f;
}

}  // namespace

double penumbra_half_width(const Light& light, double reach, double blocker) {
  if (std::isinf(reach)) return half_extent(light) * blocker;
  return blocker < reach ? half_extent(light) * blocker / (reach - blocker) : 0.0;
}

LightRays cast_rays(const Tracer& tracer, const RaysWanted& wanted, const Guides& guides,
                    const Image<SurfacePoint>& receivers) {
  LightRays out{Image<float>(guides.size, 1.0f), Image<float>(guides.size),
                Image<std::uint32_t>(guides.size, no_id)};
  const bool shared = wanted.options.count == raster::RayCount::quarter;
  const PixelCaster caster(tracer, wanted, guides.size);
  const raytrace::TileGrid grid{guides.size};
  std::vector<std::uint64_t> rays(grid.count());
  raytrace::for_each_pixel(grid, [&](int x, int y, std::size_t tile) {
    const std::size_t at = guides.index(x, y);
    if (!guides.data[at].asked()) return;
    const auto own = static_cast<std::uint32_t>(at);
    out.source.data[at] = shared ? asked_of_block(guides, x, y, wanted.frame) : own;
    if (out.source.data[at] == own) cast_pixel(tracer, caster, x, y, receivers.data[at], out, rays[tile]);
  });
  if (shared)
    parallel_for(guides.data.size(), [&](std::size_t i) {
      const std::uint32_t source = out.source.data[i];
      if (source == no_id || source == i) return;
      out.share.data[i] = out.share.data[source], out.half_width.data[i] = out.half_width.data[source];
    });
  for (const std::uint64_t tile : rays) out.rays += tile;
  return out;
}

raytrace::WorkCounts count_work(const Tracer& tracer, const RaysWanted& wanted, const Guides& guides,
                                const Image<SurfacePoint>& receivers, std::uint64_t& rays) {
  constexpr std::size_t about = 1024;
  const std::size_t step = std::max<std::size_t>(1, guides.data.size() / about);
  const PixelCaster caster(tracer, wanted, guides.size);
  raytrace::WorkCounts work;
  const auto width = static_cast<std::size_t>(guides.size.width);
  for (std::size_t i = step / 2; i < guides.data.size(); i += step) {
    if (!guides.data[i].asked()) continue;
    caster.each(static_cast<int>(i % width), static_cast<int>(i / width), receivers.data[i],
                [&](const Ray& ray) {
                  ++rays;
                  static_cast<void>(counted_closest_hit(tracer, ray, work));
                });
  }
  return work;
}

}  // namespace gnomon::rays
