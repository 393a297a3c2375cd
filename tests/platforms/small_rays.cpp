// Rays through the wide tree over a soup of triangles, vectors of floats before doubles: their hits as text, to the last bit. (What the
// floats leave to the doubles is each instruction set's own.) A part of the tracer that needs no library but the compiler's own, so
// that it is quickly made for another processor (arm64_small_test.sh).
#include <bit>
#include <cstdio>
#include <random>

#include "raytrace/bvh/wide_single.h"
#include "raytrace/bvh/wide_traverse.h"

namespace gnomon::raytrace {
namespace {

constexpr int triangle_count = 5000, ray_count = 50000, lines = 25;

/// In [-1, 1), of an engine whose numbers are the standard's.
double number(std::mt19937_64& engine) {
  return static_cast<double>(static_cast<std::int64_t>(engine())) * 0x1p-63;
}

Vec3 point(std::mt19937_64& engine) {
  const double x = number(engine), y = number(engine), z = number(engine);
  return {x, y, z};
}

Mesh soup(std::mt19937_64& engine) {
  Mesh mesh;
  for (int i = 0; i < triangle_count; ++i) {
    const Vec3 at = point(engine);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + 0.1 * point(engine));
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// A sum that every bit of every number changes (FNV-1a).
class Sum {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ (bits >> (8 * byte) & 255u)) * 0x100000001b3u;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

struct Found {
  Sum sum;
  int hits = 0, refused = 0;
};

void trace(const Structures& s, const WideTree& tree, const Ray& ray, Found& found) {
  LeafCandidates candidates;
  if (closest_candidates(tree, ray, candidates) == WideTraversal::refused) {
    ++found.refused;
    return;
  }
  Hit hit;
  if (candidates.count == 0) return;
  if (closest_found<RobustArithmetic>(s, ray, candidates, hit) != WideAnswer::hit) return;
  ++found.hits;
  found.sum.add(std::uint64_t{hit.primitive});
  for (const double value : {hit.t, hit.barycentric.x, hit.barycentric.y}) found.sum.add(value);
}

}  // namespace
}  // namespace gnomon::raytrace

int main() {
  using namespace gnomon;            // NOLINT(google-build-using-namespace)
  using namespace gnomon::raytrace;  // NOLINT(google-build-using-namespace)
  std::mt19937_64 engine(86);
  Scene scene;
  scene.meshes.push_back(soup(engine));
  scene.materials.emplace_back();
  scene.instances.emplace_back();
  const World world = make_world(scene);
  Structures s;
  s.world = &world;
  s.bvh = build_bvh(world);
  const auto tree = collapse_bvh(s.bvh, world);
  if (tree == nullptr) return 1;
  std::printf("nodes %zu leaves %zu\n", tree->nodes.size(), tree->leaves.size());
  Found found;
  for (int line = 0; line < lines; ++line) {
    for (int i = 0; i < ray_count / lines; ++i) {
      const Vec3 from = 2.0 * point(engine), to = point(engine);
      trace(s, *tree, {from, to - from}, found);
    }
    std::printf("hits %d %016llx refused %d\n", found.hits,
                static_cast<unsigned long long>(found.sum.value()), found.refused);
  }
  return 0;
}
