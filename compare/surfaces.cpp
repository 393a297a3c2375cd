#include "compare/surfaces.h"

#include <atomic>

#include "scene/parallel.h"

namespace gnomon::compare {
namespace {

// Union and find with path halving (Tarjan and van Leeuwen 1984), by several threads at a time: what is no root never
// becomes one again, and every parent is lower than its child, so that the lowest vertex stands for all.
using Parent = std::atomic_ref<std::uint32_t>;

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  for (;;) {
    const std::uint32_t up = Parent(parent[v]).load(std::memory_order_relaxed);
    if (up == v) return v;
    const std::uint32_t above = Parent(parent[up]).load(std::memory_order_relaxed);
    Parent(parent[v]).store(above, std::memory_order_relaxed);
    v = above;
  }
}

void join(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
  for (;;) {
    a = root_of(parent, a), b = root_of(parent, b);
    if (a == b) return;
    if (a < b) std::swap(a, b);
    std::uint32_t root = a;
    if (Parent(parent[a]).compare_exchange_weak(root, b, std::memory_order_relaxed)) return;
  }
}

}  // namespace

void Surfaces::connect() const {
  parent_.resize(world_.vertex_count());
  const auto for_each = [](std::size_t count, const auto& work) {
    parallel_for(static_cast<std::uint32_t>(count), 8192, work);
  };
  for_each(parent_.size(), [&](std::uint32_t v) { parent_[v] = v; });
  for_each(world_.triangle_count(), [&](std::uint32_t t) {
    join(parent_, topology_.welded(t, 0), topology_.welded(t, 1));
    join(parent_, topology_.welded(t, 0), topology_.welded(t, 2));
  });
  for (std::uint32_t v = 0; v < parent_.size(); ++v) parent_[v] = parent_[parent_[v]];  // parents are lower
}

void Surfaces::prepare() const {
  // Threads that wait for this one must not be given work that asks it.
  std::call_once(once_, [this] { run_isolated([this] { connect(); }); });
}

bool Surfaces::same(std::uint32_t a, std::uint32_t b) const {
  if (a == b) return true;
  if (!world_.is_triangle(a) || !world_.is_triangle(b)) return false;
  prepare();
  return parent_[topology_.welded(a, 0)] == parent_[topology_.welded(b, 0)];
}

bool on_smooth_surface(const raytrace::SurfacePoint& a, const raytrace::SurfacePoint& b, const World& world) {
  if (a.primitive == no_id || b.primitive == no_id) return false;
  if (!world.is_triangle(a.primitive) || !world.is_triangle(b.primitive)) return a.primitive == b.primitive;
  constexpr double least_cosine = 0.9;
  return glm::dot(a.normal, b.normal) > least_cosine;
}

}  // namespace gnomon::compare
