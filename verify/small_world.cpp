#include "verify/small_world.h"

namespace gnomon::verify {

SmallWorld::SmallWorld(Mesh mesh) : SmallWorld(scene_of({std::move(mesh)})) {}
SmallWorld::SmallWorld(std::vector<Shape> shapes) : SmallWorld(scene_of({}, std::move(shapes))) {}
SmallWorld::SmallWorld(std::vector<Mesh> meshes, std::vector<Shape> shapes)
    : SmallWorld(scene_of(std::move(meshes), std::move(shapes))) {}

Scene scene_of(std::vector<Mesh> meshes, std::vector<Shape> shapes) {
  Scene scene;
  scene.materials.emplace_back();
  for (std::uint32_t i = 0; i < meshes.size(); ++i) {
    MeshInstance instance;
    instance.mesh = i;
    scene.instances.push_back(instance);
  }
  scene.meshes = std::move(meshes);
  scene.shapes = std::move(shapes);
  return scene;
}

Shape sphere(const Vec3& center, double radius, std::uint32_t material) {
  return {"sphere", Sphere{center, radius}, material};
}
Shape plane(const Vec3& point, const Vec3& unit_normal, std::uint32_t material) {
  return {"plane", Plane{point, unit_normal}, material};
}

Mesh quad(const Vec3& origin, const Vec3& a, const Vec3& b) {
  Mesh mesh;
  mesh.positions = {origin, origin + a, origin + a + b, origin + b};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh box(const Vec3& lo, const Vec3& hi) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1) != 0 ? hi.x : lo.x, (i & 2) != 0 ? hi.y : lo.y,
                                (i & 4) != 0 ? hi.z : lo.z);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Mesh soup(int count, double extent, double size, Random& random) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 middle = random.in_box(extent);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + random.in_box(size));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Mesh round_mesh(const Vec3& center, double radius, int rings, int sectors, double jitter, Random& random) {
  Mesh mesh;
  const auto add = [&](const Vec3& n) {
    mesh.positions.push_back(center + radius * (1.0 + random.uniform(-jitter, jitter)) * n);
  };
  add({0.0, 1.0, 0.0});
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double theta = pi * i / rings, phi = 2.0 * pi * j / sectors;
      add({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)});
    }
  add({0.0, -1.0, 0.0});
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(1 + (i - 1) * sectors + j % sectors);
  };
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.push_back({0, at(1, j + 1), at(1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
    mesh.triangles.push_back({at(rings - 1, j), at(rings - 1, j + 1), last});
  }
  return mesh;
}

Mesh in_floats(Mesh mesh) {
  for (Vec3& p : mesh.positions) p = Vec3(Vec3f(p));
  return mesh;
}

Light point_light(const Vec3& position) {
  Light light;
  light.type = LightType::point;
  light.position = position;
  return light;
}
Light sun(const Vec3& direction) {
  Light light;
  light.direction = glm::normalize(direction);
  return light;
}

raytrace::SurfacePoint seen(const raytrace::Tracer& tracer, const Vec3& eye, const Vec3& target) {
  const Ray ray{eye, target - eye};
  const auto hit = tracer.closest_hit(ray);
  return hit ? tracer.surface_point(ray, *hit) : raytrace::SurfacePoint{};
}

bool same(const std::optional<raytrace::Hit>& a, const std::optional<raytrace::Hit>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->t == b->t && a->primitive == b->primitive && a->barycentric == b->barycentric;
}

Vec3 Random::direction() {
  for (;;) {
    const Vec3 d = in_box(1.0);
    const double length = glm::length(d);
    if (length > 0.1 && length <= 1.0) return d / length;
  }
}

Vec3 Random::nudged(const Vec3& p, int steps) {
  Vec3 moved = p;
  for (int a = 0; a < 3; ++a) {
    const int n = integer(-steps, steps);
    for (int i = 0; i < std::abs(n); ++i) moved[a] = std::nextafter(moved[a], n < 0 ? -infinity : infinity);
  }
  return moved;
}

}  // namespace gnomon::verify
