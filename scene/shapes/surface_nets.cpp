#include "scene/shapes/tessellate.h"

#include "scene/shapes/solid.h"

namespace gnomon {
namespace {

using Cell = std::array<int, 3>;

class Nets {
 public:
  Nets(const Implicit& implicit, int n, Mesh& mesh)
      : geometry_(implicit),
        implicit_(std::get<Implicit>(geometry_)),
        mesh_(mesh),
        margin_(implicit.closed ? 1 : 0),
        cells_(n + 2 * margin_),
        step_(implicit.box.extent() / double(n)) {}

  void build() {
    const auto side = static_cast<std::size_t>(cells_) + 1;
    values_.resize(side * side * side);
    for (int k = 0; k <= cells_; ++k)
      for (int j = 0; j <= cells_; ++j)
        for (int i = 0; i <= cells_; ++i) values_[index({i, j, k})] = value(corner({i, j, k}));
    corners_.assign(values_.size(), no_id);
    for (int k = 0; k < cells_; ++k)
      for (int j = 0; j < cells_; ++j)
        for (int i = 0; i < cells_; ++i) add_corner({i, j, k});
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k <= cells_; ++k)
        for (int j = 0; j <= cells_; ++j)
          for (int i = 0; i <= cells_; ++i) add_quad({i, j, k}, axis);
    mend_normals();
  }

 private:
  std::size_t index(const Cell& c) const {
    const auto side = static_cast<std::size_t>(cells_) + 1;
    return (static_cast<std::size_t>(c[2]) * side + static_cast<std::size_t>(c[1])) * side +
           static_cast<std::size_t>(c[0]);
  }
  Vec3 corner(const Cell& c) const {
    return implicit_.box.min + step_ * Vec3(c[0] - margin_, c[1] - margin_, c[2] - margin_);
  }
  // Without a value: outside.
  double value(const Vec3& p) const {
    double f = evaluate(implicit_.function, p.x, p.y, p.z);
    if (std::isnan(f)) f = infinity;
    if (!implicit_.closed) return f;
    for (int a = 0; a < 3; ++a) f = std::max({f, p[a] - implicit_.box.max[a], implicit_.box.min[a] - p[a]});
    return f;
  }
  bool inside(const Cell& c) const { return values_[index(c)] < 0.0; }

  // The mean of where the cell's edges are crossed, moved along the gradient onto the surface.
  void add_corner(const Cell& cell) {
    Vec3 sum(0.0);
    int crossings = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 4; ++side) {
        Cell a = cell;
        a[static_cast<std::size_t>((axis + 1) % 3)] += side & 1;
        a[static_cast<std::size_t>((axis + 2) % 3)] += side >> 1;
        Cell b = a;
        b[static_cast<std::size_t>(axis)] += 1;
        if (inside(a) == inside(b)) continue;
        const double fa = values_[index(a)], fb = values_[index(b)];
        const double share = std::isfinite(fa) && std::isfinite(fb) ? fa / (fa - fb) : 0.5;
        sum += corner(a) + share * (corner(b) - corner(a));
        ++crossings;
      }
    if (crossings == 0) return;
    const Vec3 low = corner(cell), high = low + step_;
    Vec3 p = sum / double(crossings);
    for (int i = 0; i < 3; ++i) {
      const auto f = solid_gradient(geometry_, p);
      const Vec3 next = p - (f.value / glm::dot(f.change, f.change)) * f.change;
      const bool within = glm::all(glm::greaterThanEqual(next, glm::max(low, implicit_.box.min))) &&
                          glm::all(glm::lessThanEqual(next, glm::min(high, implicit_.box.max)));
      if (!within) break;  // an edge of a cut, or a kink: the mean is the better corner
      p = next;
    }
    p = glm::clamp(p, implicit_.box.min, implicit_.box.max);
    const Vec3 world = to_world(implicit_.frame, p);
    corners_[index(cell)] = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(world);
    mesh_.normals.emplace_back(solid_normal(geometry_, world));
    mesh_.uvs.emplace_back(solid_uv(geometry_, world));
  }

  // The four cells around a crossed edge, outward side first by the right-hand rule.
  void add_quad(const Cell& at, int axis) {
    const auto a = static_cast<std::size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
    if (at[a] >= cells_ || at[b] == 0 || at[c] == 0 || at[b] >= cells_ || at[c] >= cells_) return;
    Cell end = at;
    end[a] += 1;
    if (inside(at) == inside(end)) return;
    std::array<std::uint32_t, 4> quad{};
    for (std::size_t i = 0; i < 4; ++i) {
      Cell cell = at;
      cell[b] -= i == 0 || i == 3 ? 1 : 0;
      cell[c] -= i < 2 ? 1 : 0;
      quad[i] = corners_[index(cell)];
    }
    if (!inside(at)) std::swap(quad[1], quad[3]);
    mesh_.triangles.push_back({quad[0], quad[1], quad[2]});
    mesh_.triangles.push_back({quad[0], quad[2], quad[3]});
  }

  // Where the function's gradient is no guide to the surface (it nearly vanishes, or the corner lies off the
  // surface by a kink), the triangles' own normal is.
  void mend_normals() {
    constexpr float least_agreement = 0.5f;  // cosine
    std::vector<Vec3> of_triangles(mesh_.positions.size(), Vec3(0.0));
    for (const auto& t : mesh_.triangles) {
      const Vec3& a = mesh_.positions[t[0]];
      const Vec3 area = glm::cross(mesh_.positions[t[1]] - a, mesh_.positions[t[2]] - a);
      for (const std::uint32_t corner : t) of_triangles[corner] += area;
    }
    for (std::size_t i = 0; i < of_triangles.size(); ++i) {
      const double length = glm::length(of_triangles[i]);
      if (!(length > 0.0)) continue;
      const Vec3f flat(of_triangles[i] / length);
      if (!(glm::dot(mesh_.normals[i], flat) > least_agreement)) mesh_.normals[i] = flat;
    }
  }

  const ShapeGeometry geometry_;
  const Implicit& implicit_;
  Mesh& mesh_;
  const int margin_, cells_;
  const Vec3 step_;
  std::vector<double> values_;
  std::vector<std::uint32_t> corners_;  // of the mesh, by cell
};

}  // namespace

void add_surface_nets(const Implicit& implicit, int n, Mesh& mesh) {
  Nets(implicit, n, mesh).build();
}

}  // namespace gnomon
