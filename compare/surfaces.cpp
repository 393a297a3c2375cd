#include "compare/surfaces.h"

#include <numeric>

namespace gnomon::compare {
namespace {

// Union and find with path halving (Tarjan and van Leeuwen 1984); the lower index stands for both.
std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

void join(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
  a = root_of(parent, a), b = root_of(parent, b);
  parent[std::max(a, b)] = std::min(a, b);
}

}  // namespace

void Surfaces::connect() const {
  parent_.resize(world_.vertex_count());
  std::iota(parent_.begin(), parent_.end(), 0u);
  for (std::uint32_t t = 0; t < world_.triangle_count(); ++t) {
    join(parent_, topology_.welded(t, 0), topology_.welded(t, 1));
    join(parent_, topology_.welded(t, 0), topology_.welded(t, 2));
  }
  for (std::uint32_t v = 0; v < parent_.size(); ++v) parent_[v] = parent_[parent_[v]];  // parents are lower
}

bool Surfaces::same(std::uint32_t a, std::uint32_t b) const {
  if (a == b) return true;
  if (!world_.is_triangle(a) || !world_.is_triangle(b)) return false;
  std::call_once(once_, [this] { connect(); });
  return parent_[topology_.welded(a, 0)] == parent_[topology_.welded(b, 0)];
}

bool on_smooth_surface(const raytrace::SurfacePoint& a, const raytrace::SurfacePoint& b, const World& world) {
  if (a.primitive == no_id || b.primitive == no_id) return false;
  if (!world.is_triangle(a.primitive) || !world.is_triangle(b.primitive)) return a.primitive == b.primitive;
  constexpr double least_cosine = 0.9;
  return glm::dot(a.normal, b.normal) > least_cosine;
}

}  // namespace gnomon::compare
