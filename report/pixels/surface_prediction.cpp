#include "report/pixels/surface_prediction.h"

#include <cmath>
#include <optional>

#include "report/pixels/channels.h"
#include "report/pixels/page_data.h"
#include "scene/base/parallel.h"

namespace gnomon::report {
namespace {

double dot3(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vec3 sum(const Vec3& a, const Vec3& b, double scale) {
  return {a.x + b.x * scale, a.y + b.y * scale, a.z + b.z * scale};
}

double value(std::uint32_t number) {
  return static_cast<std::int32_t>(number);
}

// The middle of the step that the numbers of a pixel stand for.
Vec3 position(const LightView& light, const LightFace& f, double u, double v, double distance) {
  const double size = light.size * position_steps;
  const double across = ((u + 0.5) * 2.0 / size - 1.0) * f.half_extent.x;
  const double up = ((v + 0.5) * 2.0 / size - 1.0) * f.half_extent.y;
  if (light.projection == LightProjection::perspective) {
    const double depth = distance / std::sqrt(1.0 + across * across + up * up);
    return sum(sum(sum(light.origin, f.right, across * depth), f.up, up * depth), f.forward, depth);
  }
  const double y = (up - f.warp * f.half_extent.y * f.half_extent.y) / (1.0 - f.warp * up);
  const double x = f.center.x + across * (1.0 + f.warp * y);
  return sum(sum(sum(light.origin, f.right, x), f.up, f.center.y + y), f.forward, distance);
}

// u and v as shares of the map from -1 to 1, and the distance.
Vec3 looked_up(const LightView& light, const LightFace& f, const Vec3& point) {
  const Vec3 d = sum(point, light.origin, -1.0);
  const double right = dot3(d, f.right), up = dot3(d, f.up), depth = dot3(d, f.forward);
  if (light.projection == LightProjection::perspective)
    return {right / depth / f.half_extent.x, up / depth / f.half_extent.y, std::sqrt(dot3(d, d))};
  const double y = up - f.center.y, stretch = 1.0 + f.warp * y;
  return {(right - f.center.x) / stretch / f.half_extent.x,
          (y + f.warp * f.half_extent.y * f.half_extent.y) / stretch / f.half_extent.y, depth};
}

std::optional<std::uint32_t> whole(double number) {
  constexpr double most = 1073741824.0;
  if (!(std::abs(number) < most)) return {};
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(number)));
}

std::array<std::uint32_t, 3> predicted(const PixelSurfaces& s, const LightView& light,
                                       const Image<std::uint8_t>& faces, const LookupNumbers& numbers,
                                       double depth_step, std::size_t i) {
  if (i == 0) return {0, 0, 0};
  const std::size_t from = s.sources[i];
  const std::array<std::uint32_t, 3> same{numbers.u[from], numbers.v[from], numbers.distance[from]};
  if (s.primitive(i) != s.primitive(from) || s.primitive(i) == no_id) return same;
  const Vec3 normal = s.normal(from);
  const Vec3 known = position(light, light.face(faces.data[from]), value(same[0]), value(same[1]),
                              value(same[2]) * depth_step);
  const auto width = static_cast<std::size_t>(s.seen.size.width);
  const std::size_t row = i / width;
  const double x = static_cast<double>(i % width) + 0.5, y = static_cast<double>(row) + 0.5;
  const Vec3 ray = sum(sum(s.rays.corner, s.rays.across, x), s.rays.down, y);
  const double t = dot3(normal, sum(known, s.rays.eye, -1.0)) / dot3(normal, ray);
  const Vec3 met = looked_up(light, light.face(faces.data[i]), sum(s.rays.eye, ray, t));
  const double half = light.size * position_steps * 0.5;
  const auto u = whole((met.x + 1.0) * half), v = whole((met.y + 1.0) * half);
  const auto distance = whole(met.z / depth_step + 0.5);
  return u && v && distance ? std::array{*u, *v, *distance} : same;
}

}  // namespace

PixelRays pixel_rays(const View& view) {
  // Parallel rays, as those of a point so far behind that they spread by less than a map position's step.
  if (view.orthographic()) {
    const double far = 1e6 * (view.half_x + view.half_y);
    const Vec3 corner = view.forward * far - view.right * view.half_x + view.up * view.half_y;
    return {view.eye - view.forward * far, corner, view.right * (2.0 * view.half_x / view.size.width),
            view.up * (-2.0 * view.half_y / view.size.height)};
  }
  const Vec3 across = view.right * (2.0 * view.tan_half_x / view.size.width);
  const Vec3 down = view.up * (-2.0 * view.tan_half_y / view.size.height);
  return {view.eye, view.forward - view.right * view.tan_half_x + view.up * view.tan_half_y, across, down};
}

PixelSurfaces pixel_surfaces(const compare::Comparison& c) {
  PixelSurfaces out;
  out.seen = c.seen.data.empty() ? compare::seen_surfaces(c.raytraced.receiver) : c.seen;
  out.rays = pixel_rays(make_view(c.world->scene->camera, out.seen.size));
  std::vector<std::uint32_t> primitives(out.count());
  for (std::size_t i = 0; i < primitives.size(); ++i) primitives[i] = out.primitive(i);
  out.sources = surface_sources(primitives);
  return out;
}

LookupNumbers predicted_lookups(const PixelSurfaces& surfaces, const LightView& light,
                                const Image<std::uint8_t>& faces, const LookupNumbers& numbers,
                                double depth_step) {
  LookupNumbers out = numbers;
  parallel_for(out.u.size(), [&](std::size_t i) {
    const auto [u, v, distance] = predicted(surfaces, light, faces, numbers, depth_step, i);
    out.u[i] = u;
    out.v[i] = v;
    out.distance[i] = distance;
  });
  return out;
}

}  // namespace gnomon::report
