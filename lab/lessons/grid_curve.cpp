// What grids of more and fewer cells cost the same rays, and what the program itself counts for its own two.
#include <array>

#include "lab/lessons/figures.h"
#include "raytrace/accel/any_structure.h"
#include "raytrace/bvh/traverse.h"
#include "raytrace/precision/error_bounds.h"
#include "scene/camera.h"
#include "scene/load.h"

namespace gnomon::lab::lessons {

namespace {

using Json = nlohmann::ordered_json;
using raytrace::WorkCounts;

constexpr std::array densities{1.0, 2.0, 4.0, 8.0, 16.0, 27.0, 64.0, 125.0};  // cells for each primitive
constexpr ImageSize picture{64, 36};  // pixels, an eye ray each; of the shape that `gnomon bench` counts

/// Where the ray meets an endless plane of the scene, which no cell holds, and which is tested by every ray; else where it ends.
double end_at_planes(const World& world, const Ray& ray, WorkCounts& work) {
  double end = ray.t.max;
  for (const Shape& shape : world.shapes)
    if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
      ++work.primitives;
      const double t =
          glm::dot(plane->normal, plane->point - ray.origin) / glm::dot(plane->normal, ray.direction);
      if (t > 0.0 && t < end) end = t;
    }
  return end;
}

/// In multiples of `d`; infinity for a miss (Möller and Trumbore 1997).
double triangle_hit(const Vec3& o, const Vec3& d, const std::array<Vec3, 3>& corners) {
  const Vec3 e = corners[1] - corners[0], f = corners[2] - corners[0], p = glm::cross(d, f),
             s = o - corners[0];
  const double det = glm::dot(e, p), u = glm::dot(s, p) / det;
  const Vec3 q = glm::cross(s, e);
  const double v = glm::dot(d, q) / det, t = glm::dot(f, q) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 ? t : infinity;
}

/// What `gnomon bench` counts: the eye's rays, and the first light's shadow rays from what they hit.
struct Rays {
  std::vector<Ray> eye, shadow;
  double count() const { return static_cast<double>(eye.size() + shadow.size()); }
};

/// `any`: the first hit ends it, as it does a shadow ray.
void count_ray(const raytrace::Structure& grid, const raytrace::CellItems& items, Ray ray, bool any,
               WorkCounts& work) {
  ray.t.max = end_at_planes(items.world(), ray, work);
  const auto frame = raytrace::make_ray_frame(ray);
  if (!frame) return;
  raytrace::BoxRay boxes(*frame, items.center());
  const Vec3 d(frame->direction[0], frame->direction[1], frame->direction[2]);
  raytrace::traverse_structure(grid, boxes, &work, [&](std::uint32_t item) {
    if (!items.is_triangle(item)) return false;
    const double t = triangle_hit(ray.origin - items.center(), d, items.corners(item));
    if (!(t < static_cast<double>(boxes.t_max))) return false;
    boxes.t_max = raytrace::float_above(t);
    return any;
  });
}

Rays rays_of(const Scene& scene, const World& world) {
  const View view = make_view(scene.camera, picture);
  const raytrace::Tracer tracer(world, raytrace::Accel::bvh);
  Rays rays;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const Ray& ray = rays.eye.emplace_back(pixel_ray(view, x + 0.5, y + 0.5));
      const auto hit = tracer.closest_hit(ray);
      if (!hit || scene.lights.empty()) continue;
      const auto point = tracer.surface_point(ray, *hit);
      if (!light_cannot_reach(scene.lights[0], point.position, point.normal))
        rays.shadow.push_back(tracer.shadow_ray(point, scene.lights[0]));
    }
  return rays;
}

Json point(double density, const WorkCounts& work, const Rays& rays) {
  return {{"density", density},
          {"cells", static_cast<double>(work.boxes) / rays.count()},
          {"triangles", static_cast<double>(work.primitives) / rays.count()}};
}

}  // namespace

Expected<nlohmann::ordered_json> grid_curve(const std::string& scene_name) {
  const auto scene = load_scene(scene_name);
  if (!scene) return fail(scene.error());
  const World world = make_world(*scene);
  const raytrace::CellItems items(world);
  const Rays rays = rays_of(*scene, world);
  Json json{{"scene", scene_name},
            {"primitives", items.count()},
            {"points", Json::array()},
            {"program", Json::array()}};
  for (const double density : densities) {
    const raytrace::Structure grid(raytrace::build_grid(items, {.density = density}));
    WorkCounts work;
    for (const Ray& ray : rays.eye) count_ray(grid, items, ray, false, work);
    for (const Ray& ray : rays.shadow) count_ray(grid, items, ray, true, work);
    json["points"].push_back(point(density, work, rays));
  }
  for (const raytrace::Accel accel : {raytrace::Accel::grid, raytrace::Accel::grid_textbook}) {
    const raytrace::Tracer tracer(world, accel);
    WorkCounts work;
    for (const Ray& ray : rays.eye) tracer.closest_hit(ray, work);
    for (const Ray& ray : rays.shadow) tracer.occluded(ray, work);
    json["program"].push_back(point(accel == raytrace::Accel::grid ? raytrace::GridOptions{}.density
                                                                   : raytrace::GridOptions::textbook_density,
                                    work, rays));
  }
  return json;
}

}  // namespace gnomon::lab::lessons
