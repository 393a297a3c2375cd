// The loops over pixels, one for each kind of path.
#pragma once

#include <limits>

#include "raytrace/packets/passes.h"
#include "raytrace/shading/shade.h"
#include "raytrace/tiles.h"

namespace gnomon::raytrace {

/// For each light of the scene its place in RayTracedFrame::lights, or npos.
std::vector<std::size_t> truth_of_light(const Scene& scene, const RayTracedFrame& frame);

/// What a tile adds to the frame's counts.
struct TileCounts {
  RayCounts rays;
  std::uint64_t non_finite = 0;

  /// The radiance, or black when it is not a number (HARD_CASES 39).
  Vec3f finite(const Vec3f& radiance) {
    if (std::isfinite(radiance.x) && std::isfinite(radiance.y) && std::isfinite(radiance.z)) return radiance;
    ++non_finite;
    return Vec3f(0.0f);
  }
};
void add_counts(const std::vector<TileCounts>& tiles, RayTracedFrame& frame);

/// What the eye sees of a point. In glass the way to it counts too.
template <class Kind, class Shadow>
Vec3f seen(Shader<Kind>& shader, const PictureInput& input, const SurfacePoint& point, PathOf<Kind> path,
           RayCounts& rays, const Shadow& shadow) {
  if constexpr (Kind::refracts) {
    path.inside = input.eye;
    if (!path.inside.empty())
      return shader.arriving(point, glm::length(point.position - input.view.eye), path, rays.refraction);
  }
  return shader.leaving(point, path, shadow);
}

/// receiver(x, y, tile index, point) for every pixel's centre.
template <class Receiver>
void for_each_receiver(const PictureInput& input, const RayTracedFrame& frame, const TileGrid& grid,
                       const Receiver& receiver) {
  for_each_tile(grid, [&](std::size_t tile, int x0, int y0, int x1, int y1) {
    std::array<SurfacePoint, tile_rays> found;
    const SurfacePoint* points = found.data();
    std::size_t stride = tile_pixels;
    if (input.unstored != nullptr)
      input.unstored->source(input.tracer, input.view, tile).fill({x0, y0, x1, y1}, every_lane, found.data());
    else
      points = &frame.receiver.at(x0, y0), stride = static_cast<std::size_t>(grid.size.width);
    for (int y = y0; y < y1; ++y, points += stride)
      for (int x = x0; x < x1; ++x) receiver(x, y, tile, points[x - x0]);
  });
}

/// One sample, at the pixel's centre, where receivers and shadows are known.
template <class Kind>
void shade_centres(const PictureInput& input, RayTracedFrame& frame) {
  const Scene& scene = *input.tracer.world().scene;
  const std::vector<std::size_t> truth = truth_of_light(scene, frame);
  const TileGrid grid{input.options.size, input.options.stop};
  std::vector<TileCounts> counts(grid.count());
  for_each_receiver(input, frame, grid, [&](int x, int y, std::size_t tile, const SurfacePoint& point) {
    if (grid.stop.stop_requested()) return;  // a pixel may have thousands of paths
    if (point.primitive == no_id) {
      frame.color.at(x, y) = scene.background;
      return;
    }
    RayCounts& rays = counts[tile].rays;
    Shader<Kind> shader(input, input.first_pixel() + frame.color.index(x, y), rays);
    const PathOf<Kind> path{.direction = pixel_ray(input.view, x + 0.5, y + input.first_row + 0.5).direction};
    // A visibility already known saves the ray, but for light that glass may let through and for ambiguous
    // pixels.
    const auto shadow = [&](std::uint32_t i) {
      if (truth[i] < frame.lights.size()) {
        const Image<float>& visibility = frame.lights[truth[i]].visibility;
        if (!visibility.data.empty())
          return Kind::refracts && visibility.at(x, y) < 1.0f ? shader.transmittance(point, path, i)
                                                              : Vec3f(visibility.at(x, y));
        const PointVisibility centre = frame.lights[truth[i]].centre.at(x, y);
        if (centre == PointVisibility::lit) return Vec3f(1.0f);
        if (centre == PointVisibility::shadowed && !Kind::refracts) return Vec3f(0.0f);
      }
      return shader.transmittance(point, path, i);
    };
    frame.color.at(x, y) = counts[tile].finite(seen(shader, input, point, path, rays, shadow));
  });
  add_counts(counts, frame);
}

/// Several samples, spread over the pixel's area, each with its own ray from the eye; their mean is the
/// pixel.
template <class Kind>
void shade_samples(const PictureInput& input, RayTracedFrame& frame) {
  const Tracer& tracer = input.tracer;
  const int per_pixel = input.options.samples_per_pixel;
  const bool traced_centres = !frame.receiver.data.empty();
  const TileGrid grid{input.options.size, input.options.stop};
  std::vector<TileCounts> counts(grid.count());
  for_each_pixel(grid, [&](int x, int y, std::size_t tile) {
    RayCounts& rays = counts[tile].rays;
    const std::size_t pixel = frame.color.index(x, y);
    Shader<Kind> shader(input, input.first_pixel() + pixel, rays);
    const StratifiedSquare square(static_cast<std::uint32_t>(per_pixel), shader.next_key());
    Vec3 sum(0.0);
    for (int s = 0; s < per_pixel && !grid.stop.stop_requested(); ++s) {
      const Vec2 place = square[static_cast<std::uint32_t>(s)];
      const Ray ray = pixel_ray(input.view, x + place.x, y + input.first_row + place.y);
      if (s > 0 || traced_centres) ++rays.antialiasing;
      const std::optional<Hit> hit = tracer.closest_seen(ray);
      if (!hit) {
        sum += Vec3(tracer.world().scene->background);
        continue;
      }
      const PathOf<Kind> path{.direction = ray.direction, .siblings = per_pixel};
      const SurfacePoint point = tracer.surface_point(ray, *hit);
      const auto shadow = [&](std::uint32_t i) { return shader.transmittance(point, path, i); };
      sum += Vec3(counts[tile].finite(seen(shader, input, point, path, rays, shadow)));
    }
    frame.color.data[pixel] = Vec3f(sum / static_cast<double>(per_pixel));
  });
  add_counts(counts, frame);
}

}  // namespace gnomon::raytrace
