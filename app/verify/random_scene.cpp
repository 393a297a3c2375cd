#include "app/verify/random_scene.h"

#include <glm/gtc/matrix_transform.hpp>

#include "app/verify/small_world.h"
#include "scene/light.h"

namespace gnomon::verify {

namespace {

/// A multiple of 1/4 in [low, high].
double quarter(Random& r, double low, double high) {
  return 0.25 * r.integer(static_cast<int>(4.0 * low), static_cast<int>(4.0 * high));
}

Vec3 place(Random& r) {
  return {quarter(r, -2.0, 2.0), quarter(r, 0.25, 2.25), quarter(r, -2.0, 2.0)};
}

Mesh random_box(Random& r) {
  const Vec3 low = place(r);
  return box(low, low + Vec3{quarter(r, 0.25, 1.0), quarter(r, 0.25, 1.0), quarter(r, 0.25, 1.0)});
}

Mesh loose_triangles(Random& r, int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 first = place(r);
    const auto corner = [&] {
      return first + Vec3{quarter(r, -1, 1), quarter(r, -0.25, 1), quarter(r, -1, 1)};
    };
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : {first, corner(), corner()}) mesh.positions.push_back(p);
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  return mesh;
}

Vec3 in_plane(Random& r, const std::array<Vec3, 3>& corners) {
  const double u = 0.5 * r.integer(-3, 6), v = 0.5 * r.integer(-3, 6);
  return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

Shape random_sphere(Random& r) {
  const Vec3 center = place(r);
  return sphere(center, quarter(r, 0.25, 1.0));
}

/// In the plane of a random face, at one of its corners, inside a box or a sphere, or anywhere.
Vec3 light_place(const Scene& scene, Random& r) {
  const Mesh& any = scene.meshes[r.below(static_cast<std::uint32_t>(scene.meshes.size()))];
  const Mesh& m = r.coin() ? scene.meshes.back() : any;  // the loose triangles lie in no axis-parallel plane
  const auto& t = m.triangles[r.below(static_cast<std::uint32_t>(m.triangles.size()))];
  const Vec3 a = m.positions[t[0]], b = m.positions[t[1]], c = m.positions[t[2]];
  switch (r.below(5)) {
    case 0:
      return a;
    case 1:
      return 0.5 * (m.positions.front() + m.positions.back());
    case 2:
      return {quarter(r, -3, 3), quarter(r, 2, 5), quarter(r, -3, 3)};
    default:
      return in_plane(r, {a, b, c});
  }
}

Light random_light(const Scene& scene, Random& r) {
  Light light = point_light(light_place(scene, r));
  const auto type = r.below(4);
  if (type == 0) {
    const Mesh& m = scene.meshes[r.below(static_cast<std::uint32_t>(scene.meshes.size()))];
    const Vec3 along = m.positions[1] - m.positions[0];  // often in the planes of faces
    Vec3 direction = r.coin() ? along : Vec3{quarter(r, -1, 1), -1.0, quarter(r, -1, 1)};
    if (direction == Vec3(0.0)) direction = Vec3(0.0, -1.0, 0.0);
    light = sun(direction.y > 0.0 ? -direction : direction);
  } else if (type == 1) {
    light.type = LightType::spot;
    light.direction = glm::normalize(Vec3{quarter(r, -0.5, 0.5), -1.0, quarter(r, -0.5, 0.5)});
    light.outer_angle = 0.7;
  }
  return light;
}

/// Rotates, scales by 1/1000 to 1000, and moves by up to 10,000 times the scene's size.
void turn(Scene& scene, Random& r) {
  const double angle = r.uniform(0.0, 2.0 * pi);
  const Mat3 rotation(glm::rotate(Mat4(1.0), angle, r.direction()));
  const double scale = r.power_of_ten(-3.0, 3.0), reach = scale * r.power_of_ten(-1.0, 4.0);
  const Vec3 by = r.in_box(reach);
  const auto place = [&](Vec3& p) { p = scale * (rotation * p) + by; };
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) place(p);
  for (Shape& shape : scene.shapes) {
    if (auto* plane = std::get_if<Plane>(&shape.geometry))
      place(plane->point), plane->normal = rotation * plane->normal;
    if (auto* sphere = std::get_if<Sphere>(&shape.geometry)) place(sphere->center), sphere->radius *= scale;
  }
  for (Light& light : scene.lights) place(light.position), light.direction = rotation * light.direction;
  place(scene.camera.eye), place(scene.camera.target), scene.camera.up = rotation * scene.camera.up;
}

}  // namespace

Scene random_scene(Random& r) {
  std::vector<Mesh> meshes;
  for (int i = r.integer(1, 4); i > 0; --i) meshes.push_back(random_box(r));
  meshes.push_back(loose_triangles(r, r.integer(1, 12)));
  std::vector<Shape> shapes{plane(Vec3(0.0), Vec3(0.0, 1.0, 0.0))};
  if (r.below(3) == 0) shapes.push_back(plane({-3.0, 0.0, 0.0}, {1.0, 0.0, 0.0}));
  for (int i = r.integer(0, 2); i > 0; --i) shapes.push_back(random_sphere(r));
  Scene scene = scene_of(std::move(meshes), std::move(shapes));
  scene.lights = {random_light(scene, r)};
  scene.camera.eye = Vec3(4.0, 2.0, 3.5) + Vec3{quarter(r, 0, 1), quarter(r, 0, 2), quarter(r, 0, 1)};
  scene.camera.target = {quarter(r, -0.5, 0.5), 0.5, quarter(r, -0.5, 0.5)};
  if (r.coin()) turn(scene, r);
  return scene;
}

Scene invariant_scene(LightType type, Random random) {
  Mesh loose = soup(30, 1.5, 0.8, random);
  for (Vec3& p : loose.positions) p = glm::round(64.0 * p) / 64.0;
  Scene scene =
      scene_of({quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}), box({-1, 0.5, -1}, {0, 1.5, 0}), std::move(loose)});
  Light light = point_light({-1.75, 3.25, 1.5});
  light.type = type;
  light.direction = glm::normalize(Vec3(0.5, -1.0, -0.375));
  light.outer_angle = 0.7;
  scene.lights = {light};
  scene.camera.eye = {3.5, 2.5, 4.0}, scene.camera.target = {0.0, 0.5, 0.0};
  return scene;
}

Agreement compare_with_rays(const Scene& scene, const raster::RasterFrame& drawn,
                            const raytrace::RayTracedFrame& traced) {
  Agreement out;
  for (std::size_t i = 0; i < traced.receiver.data.size(); ++i) {
    const raytrace::SurfacePoint& p = traced.receiver.data[i];
    const raytrace::PointVisibility truth = traced.lights[0].centre.data[i];
    if (p.primitive == no_id || p.primitive != drawn.primitive.data[i]) continue;
    if (truth == raytrace::PointVisibility::uncertain ||
        light_cannot_reach(scene.lights[0], p.position, p.normal))
      continue;
    ++out.asked;
    out.wrong +=
        (drawn.lights[0].visibility.data[i] > 0.5f) == (truth == raytrace::PointVisibility::lit) ? 0 : 1;
  }
  return out;
}

}  // namespace gnomon::verify
