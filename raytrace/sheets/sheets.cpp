#include "raytrace/sheets.h"

#include <numeric>

#include "raytrace/shapes/intersect.h"
#include "raytrace/sheets/column.h"
#include "raytrace/sheets/shape_sheets.h"
#include "scene/solid.h"

namespace gnomon::raytrace {
namespace {

class Splitter {
 public:
  Splitter(const World& world, const Topology& topology, const LightView& view, TexelKey texel,
           std::span<const std::uint32_t> triangles)
      : world_(world),
        topology_(topology),
        column_(view, texel.face(), texel.column(), texel.row()),
        ids_(triangles),
        middle_(make_ray_frame(texel_ray(view, texel.face(), texel.column() + 0.5, texel.row() + 0.5))) {}

  const TexelColumn& column() const { return column_; }

  void split(std::vector<Sheet>& sheets) {
    nodes_.resize(ids_.size());
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) load(i);
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
      for (int k = 0; k < 3; ++k) join_across(i, k);
    gather(sheets);
  }

 private:
  struct Node {  // a triangle of the list
    std::array<LightVertex, 3> corners;
    int facing;
    bool boundary;
    std::uint32_t parent;  // of the union-find forest; a root is the lowest of its tree
  };
  using Members = std::span<const std::uint32_t>;

  void load(std::uint32_t i) {
    const auto corners = world_.corners(ids_[i]);
    Node& node = nodes_[i];
    for (std::size_t k = 0; k < 3; ++k) node.corners[k] = column_.vertex(corners[k]);
    node.facing = column_.facing(node.corners);
    node.boundary = node.facing == 0 || world_.is_masked(ids_[i]);
    node.parent = i;
  }

  std::uint32_t root(std::uint32_t i) {
    while (nodes_[i].parent != i) i = nodes_[i].parent = nodes_[nodes_[i].parent].parent;
    return i;
  }

  /// The place of a triangle in the list, or its size.
  std::size_t index_of(std::uint32_t triangle) const {
    const auto at = std::lower_bound(ids_.begin(), ids_.end(), triangle);
    return at != ids_.end() && *at == triangle ? static_cast<std::size_t>(at - ids_.begin()) : ids_.size();
  }

  void join_across(std::uint32_t i, int edge) {
    const auto k = static_cast<std::size_t>(edge);
    Node& node = nodes_[i];
    if (column_.surely_misses(node.corners[k], node.corners[(k + 1) % 3])) return;
    const std::uint32_t across = topology_.across(ids_[i], edge);
    const std::size_t j =
        across == Topology::boundary || across == Topology::non_manifold ? ids_.size() : index_of(across);
    if (j == ids_.size() || node.facing == 0 || node.facing != nodes_[j].facing) {
      node.boundary = true;
      return;
    }
    const std::uint32_t a = root(i), b = root(static_cast<std::uint32_t>(j));
    nodes_[std::max(a, b)].parent = std::min(a, b);
  }

  // Components in the order of their lowest triangle, members ascending.
  void gather(std::vector<Sheet>& sheets) {
    std::vector<std::uint32_t> order(nodes_.size());
    std::iota(order.begin(), order.end(), 0U);
    for (const std::uint32_t i : order) nodes_[i].parent = root(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return nodes_[a].parent < nodes_[b].parent; });
    for (std::size_t first = 0; first < order.size();) {
      std::size_t end = first + 1;
      while (end < order.size() && nodes_[order[end]].parent == nodes_[order[first]].parent) ++end;
      add_sheet(Members(order).subspan(first, end - first), sheets);
      first = end;
    }
  }

  void add_sheet(Members members, std::vector<Sheet>& sheets) {
    bool boundary = false;
    for (const std::uint32_t i : members) boundary = boundary || nodes_[i].boundary;
    boundary = boundary || winds_twice(members);
    // Without boundary a sheet covers the column or lies beside it: its middle decides, half a texel from where
    // that is uncertain.
    if (!boundary && !intersects_middle(members)) return;
    Interval range{infinity, -infinity};
    for (const std::uint32_t i : members) {
      const Interval part = column_.distances(nodes_[i].corners);
      range.min = std::min(range.min, part.min), range.max = std::max(range.max, part.max);
    }
    if (range.empty()) return;
    Sheet& sheet = sheets.emplace_back();
    sheet.primitives.reserve(members.size());
    for (const std::uint32_t i : members) sheet.primitives.push_back(ids_[i]);
    sheet.faces_light = nodes_[members.front()].facing > 0;
    sheet.has_boundary = boundary;
    sheet.nearest = range.min, sheet.farthest = range.max;
  }

  bool intersects_middle(Members members) const {
    for (const std::uint32_t i : members) {
      const auto [a, b, c] = world_.corners(ids_[i]);
      TriangleHit hit;
      if (middle_ && intersect_triangle(*middle_, {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}}, hit))
        return true;
    }
    return false;
  }

  /// Some vertex that may lie in the column has a fan that winds round it more than once, as projected: then
  /// more than one of the fan's wedges holds the direction +x. All wedges turn the same way, for the sheet
  /// faces one way.
  bool winds_twice(Members members) const {
    std::vector<std::uint32_t> held;  // welded vertices, once for each wedge that holds +x
    for (const std::uint32_t i : members) {
      const auto& corners = nodes_[i].corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const LightVertex& v = corners[k];
        if (!column_.may_contain(v)) continue;
        const Vec3 up = glm::cross(v.h, Vec3(1.0, 0.0, 0.0));  // the side of the line through v along x
        const bool from = glm::dot(up, corners[(k + 1) % 3].h) >= 0.0;
        const bool to = glm::dot(up, corners[(k + 2) % 3].h) >= 0.0;
        const bool holds_x = turns_left(i) ? !from && to : from && !to;
        if (holds_x) held.push_back(topology_.welded(ids_[i], static_cast<int>(k)));
      }
    }
    std::sort(held.begin(), held.end());
    return std::adjacent_find(held.begin(), held.end()) != held.end();
  }

  // Counter-clockwise in (x, y), when the vertex has h.z > 0.
  bool turns_left(std::uint32_t i) const {
    const auto& t = nodes_[i].corners;
    return glm::dot(glm::cross(t[0].h, t[1].h), t[2].h) > 0.0;
  }

  const World& world_;
  const Topology& topology_;
  const TexelColumn column_;
  std::span<const std::uint32_t> ids_;
  std::optional<RayFrame> middle_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<Sheet> find_sheets(const World& world, const Topology& topology, const LightView& view,
                               TexelKey texel, std::span<const std::uint32_t> primitives) {
  const auto triangles_end = std::lower_bound(primitives.begin(), primitives.end(), world.triangle_count());
  const auto triangle_count = static_cast<std::size_t>(triangles_end - primitives.begin());
  std::vector<Sheet> sheets;
  Splitter splitter(world, topology, view, texel, primitives.first(triangle_count));
  splitter.split(sheets);
  for (const std::uint32_t id : primitives.subspan(triangle_count)) {
    const Shape& shape = world.shape(id);
    const bool masked = world.is_masked(id);
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
      append_sphere_sheets(*sphere, id, masked, splitter.column(), sheets);
    else if (is_solid(shape.geometry))
      append_solid_sheets(shape.geometry, id, masked, splitter.column(), sheets);
    else
      append_plane_sheet(std::get<Plane>(shape.geometry), id, masked, splitter.column(), sheets);
  }
  return sheets;
}

std::size_t sheet_of(std::span<const Sheet> sheets, std::uint32_t primitive, bool faces_light) {
  std::size_t found = sheets.size();
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (!std::binary_search(sheets[i].primitives.begin(), sheets[i].primitives.end(), primitive)) continue;
    if (sheets[i].faces_light == faces_light) return i;
    if (found == sheets.size()) found = i;
  }
  return found;
}

}  // namespace gnomon::raytrace
