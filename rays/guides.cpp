#include "rays/guides.h"

#include "scene/base/parallel.h"

namespace gnomon::rays {
namespace {

/// The depth at which a pixel's ray meets the plane, less that of the plane's own pixel; 0 where it does not meet it before the
/// eye.
double depth_step(const View& view, const Vec3& position, const Vec3& normal, const Vec2& pixel,
                  double depth) {
  const Ray ray = pixel_ray(view, pixel.x, pixel.y);
  const double t = glm::dot(normal, position - ray.origin) / glm::dot(normal, ray.direction);
  if (!(t > 0.0) || !std::isfinite(t)) return 0.0;
  return glm::dot(ray.origin + t * ray.direction - view.eye, view.forward) - depth;
}

Guide guide_of(const View& view, const Vec2& pixel, const raytrace::SurfacePoint& point) {
  Guide guide;
  const Vec3 place = point.position - view.eye;
  const double depth = glm::dot(place, view.forward);
  guide.place = Vec3f(place);
  guide.normal = Vec3f(point.normal);
  guide.depth = static_cast<float>(depth);
  guide.footprint = static_cast<float>(pixel_footprint(view, view.distance(point.position)));
  for (int axis = 0; axis < 2; ++axis) {
    Vec2 beside = pixel;
    beside[axis] += 1.0;
    guide.depth_slope[axis] =
        static_cast<float>(depth_step(view, point.position, point.normal, beside, depth));
  }
  return guide;
}

}  // namespace

Guides make_guides(const raytrace::Tracer& tracer, const View& view, int first_row, const Light& light,
                   const Image<raytrace::SurfacePoint>& receivers) {
  Guides guides(receivers.size);
  parallel_for(receivers.size.height, [&](int y) {
    for (int x = 0; x < receivers.size.width; ++x) {
      const raytrace::SurfacePoint& point = receivers.at(x, y);
      if (point.primitive == no_id || light_cannot_reach(light, point.position, point.normal) ||
          !tracer.receives_shadow(point))
        continue;
      guides.at(x, y) = guide_of(view, {x + 0.5, first_row + y + 0.5}, point);
    }
  });
  return guides;
}

}  // namespace gnomon::rays
