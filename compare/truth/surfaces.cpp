#include "compare/truth/surfaces.h"

#include <atomic>
#include <cmath>

#include "scene/base/parallel.h"
#include "scene/base/ranges.h"

namespace gnomon::compare {
namespace {

// Union and find with path halving (Tarjan and van Leeuwen 1984), by several threads at a time. What is no root never
// becomes one again, and every parent is lower than its child, so that the lowest vertex stands for all.
using Parents = raytrace::HugeArray<std::uint32_t>;
using Parent = std::atomic_ref<std::uint32_t>;

std::uint32_t root_of(Parents& parent, std::uint32_t v) {
  for (;;) {
    const std::uint32_t up = Parent(parent[v]).load(std::memory_order_relaxed);
    if (up == v) return v;
    const std::uint32_t above = Parent(parent[up]).load(std::memory_order_relaxed);
    Parent(parent[v]).store(above, std::memory_order_relaxed);
    v = above;
  }
}

void join(Parents& parent, std::uint32_t a, std::uint32_t b) {
  for (;;) {
    a = root_of(parent, a), b = root_of(parent, b);
    if (a == b) return;
    if (a < b) std::swap(a, b);
    std::uint32_t root = a;
    if (Parent(parent[a]).compare_exchange_weak(root, b, std::memory_order_relaxed)) return;
  }
}

/// Some parts' vertices or triangles.
class Numbers {
 public:
  void add(std::uint32_t first, std::uint32_t count) {
    firsts_.push_back(first);
    begins_.push_back(begins_.back() + count);
  }
  template <class Work>
  void for_each(const Work& work) const {
    const Ranges ranges(begins_);
    parallel_for(ranges.size(), 8192, [&](std::uint32_t i) {
      const std::uint32_t range = ranges.of(i);
      work(firsts_[range] + (i - ranges.begin_of(range)));
    });
  }

 private:
  std::vector<std::uint32_t> firsts_, begins_{0};
};

}  // namespace

void Surfaces::connect() const {
  Numbers vertices, triangles;
  for (const WorldPart& part : world_.parts) {
    const bool empty = part.triangle_count() == 0;  // and may yet hold the lowest vertex at a place
    if (!empty && topology_.shared(part.first_triangle) != part.first_triangle) continue;
    vertices.add(part.first_vertex, part.vertex_count());
    triangles.add(part.first_triangle, part.triangle_count());
  }
  parent_ = raytrace::HugeArray<std::uint32_t>(world_.vertex_count());
  vertices.for_each([&](std::uint32_t v) { parent_[v] = v; });
  triangles.for_each([&](std::uint32_t t) {
    const std::uint32_t corner = topology_.welded(t, 0);
    join(parent_, corner, topology_.welded(t, 1));
    join(parent_, corner, topology_.welded(t, 2));
  });
  vertices.for_each(
      [&](std::uint32_t v) { Parent(parent_[v]).store(root_of(parent_, v), std::memory_order_relaxed); });
}

void Surfaces::prepare() const {
  // Threads that wait for this one must not be given work that asks it.
  std::call_once(once_, [this] { run_isolated([this] { connect(); }); });
}

bool Surfaces::same(std::uint32_t a, std::uint32_t b) const {
  if (a == b) return true;
  if (!world_.is_triangle(a) || !world_.is_triangle(b)) return false;
  prepare();
  const std::uint32_t shared_a = topology_.shared(a), shared_b = topology_.shared(b);
  const bool of_one_instance = a - shared_a == b - shared_b;  // 0 of what shares nothing
  return of_one_instance && parent_[topology_.welded(shared_a, 0)] == parent_[topology_.welded(shared_b, 0)];
}

bool on_smooth_surface(const raytrace::SurfacePoint& a, const raytrace::SurfacePoint& b, const World& world) {
  if (a.primitive == no_id || b.primitive == no_id) return false;
  if (!world.is_triangle(a.primitive) || !world.is_triangle(b.primitive)) return a.primitive == b.primitive;
  constexpr double least_cosine = 0.9, slack = 0.02;
  if (!(glm::dot(a.normal, b.normal) > least_cosine)) return false;
  // Where two planes meet in an edge, the chord's angles to both sum to the angle between the planes, and so they do on an arc.
  const Vec3 chord = b.position - a.position;
  return std::abs(glm::dot(chord, a.normal)) + std::abs(glm::dot(chord, b.normal)) <=
         glm::length(chord) * (glm::length(a.normal - b.normal) + slack);
}

}  // namespace gnomon::compare
