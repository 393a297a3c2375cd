// No two triangles of a built-in scene lie in the same plane, face the same way and overlap: such a pair has
// no truth to compare with, since either of the two may win. (Faces that touch back to back, a box on a
// floor, are allowed.)
#include <gtest/gtest.h>

#include <map>

#include "scene/load.h"
#include "scene/world.h"

namespace gnomon {
namespace {

using Polygon = std::vector<Vec2>;

double area(const Polygon& p) {
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 &a = p[i], &b = p[(i + 1) % p.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

// Sutherland-Hodgman: the part of `subject` inside the counter-clockwise triangle `clip`.
Polygon intersection(Polygon subject, const Polygon& clip) {
  for (std::size_t i = 0; i < clip.size() && subject.size() > 2; ++i) {
    const Vec2 a = clip[i], b = clip[(i + 1) % clip.size()];
    const auto side = [&](const Vec2& p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); };
    Polygon kept;
    for (std::size_t k = 0; k < subject.size(); ++k) {
      const Vec2 p = subject[k], q = subject[(k + 1) % subject.size()];
      const double dp = side(p), dq = side(q);
      if (dp >= 0.0) kept.push_back(p);
      if ((dp >= 0.0) != (dq >= 0.0)) kept.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    subject = std::move(kept);
  }
  return subject.size() > 2 ? subject : Polygon{};
}

struct Facet {
  std::uint32_t triangle;
  Polygon outline;
  Vec2 min{infinity}, max{-infinity};
};

bool boxes_overlap(const Facet& a, const Facet& b) {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

std::string describe(const World& world, std::uint32_t a, std::uint32_t b) {
  const auto name = [&](std::uint32_t t) { return world.scene->instances[world.object_of(t)].name; };
  const Vec3 p = world.corners(a)[0];
  return name(a) + " and " + name(b) + " near " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' +
         std::to_string(p.z);
}

// Coplanar within 1e-5 (10 micrometres): nearer than any two faces that a scene's author would set apart.
std::vector<std::string> overlaps(const World& world) {
  std::map<std::array<long long, 4>, std::vector<Facet>> planes;
  for (std::uint32_t t = 0; t < world.triangle_count(); ++t) {
    const auto c = world.corners(t);
    const Vec3 n = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
    const std::array<long long, 4> key{std::llround(1e5 * n.x), std::llround(1e5 * n.y),
                                       std::llround(1e5 * n.z), std::llround(1e5 * glm::dot(n, c[0]))};
    Vec3 right, up;
    orthonormal_basis(glm::normalize(Vec3(key[0], key[1], key[2])), right, up);
    Facet f{t, {}};
    for (const Vec3& p : c) {
      f.outline.emplace_back(glm::dot(right, p), glm::dot(up, p));
      f.min = glm::min(f.min, f.outline.back()), f.max = glm::max(f.max, f.outline.back());
    }
    planes[key].push_back(std::move(f));
  }
  std::vector<std::string> found;
  for (const auto& [key, facets] : planes) {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      for (std::size_t k = i + 1; k < facets.size(); ++k) {
        if (!boxes_overlap(facets[i], facets[k])) continue;
        if (area(intersection(facets[i].outline, facets[k].outline)) < 1e-7)
          continue;  // a tenth of a square millimetre
        found.push_back(describe(world, facets[i].triangle, facets[k].triangle));
      }
    }
  }
  return found;
}

TEST(BuiltinScenes, HaveNoCoplanarOverlaps) {
  for (const BuiltinScene& s : builtin_scenes()) {
    if (s.large) continue;
    const Expected<Scene> scene = load_scene(std::string(s.name));
    ASSERT_TRUE(scene) << scene.error().message();
    const auto found = overlaps(make_world(*scene));
    EXPECT_TRUE(found.empty()) << s.name << ": " << found.size() << " pairs, the first: " << found.front();
  }
}

TEST(CoplanarOverlaps, AreFound) {
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  for (const double shift : {0.0, 0.4}) {
    MeshInstance instance{"piece", 0, Mat4(1.0), 0};
    instance.world_from_object[3] = Vec4(shift, 0.0, 0.0, 1.0);
    scene.instances.push_back(instance);
  }
  EXPECT_EQ(overlaps(make_world(scene)).size(), 1u);
  scene.instances[1].world_from_object[3].x = 1.1;  // side by side
  EXPECT_TRUE(overlaps(make_world(scene)).empty());
  scene.instances[1].world_from_object[3] = Vec4(0.4, 0.0, 0.01, 1.0);  // one behind the other
  EXPECT_TRUE(overlaps(make_world(scene)).empty());
}

}  // namespace
}  // namespace gnomon
