#include "raytrace/sheets.h"

#include <numeric>

#include "raytrace/column.h"
#include "raytrace/intersect.h"
#include "raytrace/shape_sheets.h"

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

  const Column& column() const { return column_; }

  void split(std::vector<Sheet>& sheets) {
    const std::size_t n = ids_.size();
    parent_.resize(n), boundary_.assign(n, false), corners_.resize(n), facing_.resize(n);
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t i = 0; i < n; ++i) load(i);
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 3; ++k) join_across(i, k);
    gather(sheets);
  }

 private:
  void load(std::size_t i) {
    const auto corners = world_.corners(ids_[i]);
    for (std::size_t k = 0; k < 3; ++k) corners_[i][k] = column_.vertex(corners[k]);
    facing_[i] = column_.facing(corners_[i]);
    const Material& material = world_.scene->materials[world_.triangle_material[ids_[i]]];
    boundary_[i] = facing_[i] == 0 || material.alpha_mode == AlphaMode::mask;
  }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  std::size_t index_of(std::uint32_t triangle) const {
    const auto at = std::lower_bound(ids_.begin(), ids_.end(), triangle);
    return at != ids_.end() && *at == triangle ? static_cast<std::size_t>(at - ids_.begin()) : ids_.size();
  }

  void join_across(std::size_t i, int edge) {
    const auto k = static_cast<std::size_t>(edge);
    if (column_.surely_misses(corners_[i][k], corners_[i][(k + 1) % 3])) return;
    const std::uint32_t across = topology_.across(ids_[i], edge);
    const std::size_t j =
        across == Topology::boundary || across == Topology::non_manifold ? ids_.size() : index_of(across);
    if (j == ids_.size() || facing_[i] == 0 || facing_[i] != facing_[j]) {
      boundary_[i] = true;
      return;
    }
    parent_[root(i)] = root(j);
  }

  void gather(std::vector<Sheet>& sheets) {
    // Components in the order of their lowest triangle.
    const std::size_t n = ids_.size();
    std::vector<std::vector<std::size_t>> components;
    std::vector<std::size_t> component_of_root(n, n);
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t& c = component_of_root[root(i)];
      if (c == n) c = components.size(), components.emplace_back();
      components[c].push_back(i);
    }
    for (const std::vector<std::size_t>& members : components) add_sheet(members, sheets);
  }

  void add_sheet(const std::vector<std::size_t>& members, std::vector<Sheet>& sheets) {
    Sheet sheet;
    sheet.faces_light = facing_[members.front()] > 0;
    for (const std::size_t i : members) {
      sheet.primitives.push_back(ids_[i]);
      sheet.has_boundary = sheet.has_boundary || boundary_[i];
    }
    sheet.has_boundary = sheet.has_boundary || winds_twice(members);
    // Without boundary a sheet covers the column or lies beside it: its middle decides, half a texel from any
    // doubt.
    if (!sheet.has_boundary && !meets_middle(members)) return;
    Interval range{infinity, -infinity};
    for (const std::size_t i : members) {
      const Interval part = column_.distances(corners_[i]);
      range.min = std::min(range.min, part.min), range.max = std::max(range.max, part.max);
    }
    if (range.empty()) return;
    sheet.nearest = range.min, sheet.farthest = range.max;
    sheets.push_back(std::move(sheet));
  }

  bool meets_middle(const std::vector<std::size_t>& members) const {
    for (const std::size_t i : members) {
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
  bool winds_twice(const std::vector<std::size_t>& members) const {
    std::vector<std::pair<std::uint32_t, int>> crossings;  // welded vertex, wedges holding +x
    for (const std::size_t i : members) {
      for (std::size_t k = 0; k < 3; ++k) {
        const LightVertex& v = corners_[i][k];
        if (!column_.may_contain(v)) continue;
        const Vec3 up = glm::cross(v.h, Vec3(1.0, 0.0, 0.0));  // the side of the line through v along x
        const bool from = glm::dot(up, corners_[i][(k + 1) % 3].h) >= 0.0;
        const bool to = glm::dot(up, corners_[i][(k + 2) % 3].h) >= 0.0;
        const bool holds_x = turns_left(i) ? !from && to : from && !to;
        if (holds_x) crossings.emplace_back(topology_.welded(ids_[i], static_cast<int>(k)), 1);
      }
    }
    std::sort(crossings.begin(), crossings.end());
    return std::adjacent_find(crossings.begin(), crossings.end()) != crossings.end();
  }

  // Counter-clockwise in (x, y), when the vertex has h.z > 0.
  bool turns_left(std::size_t i) const {
    const auto& t = corners_[i];
    return glm::dot(glm::cross(t[0].h, t[1].h), t[2].h) > 0.0;
  }

  const World& world_;
  const Topology& topology_;
  const Column column_;
  std::span<const std::uint32_t> ids_;
  std::optional<RayFrame> middle_;
  std::vector<std::size_t> parent_;
  std::vector<bool> boundary_;
  std::vector<std::array<LightVertex, 3>> corners_;
  std::vector<int> facing_;
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
    const bool masked = world.scene->materials[shape.material].alpha_mode == AlphaMode::mask;
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
      append_sphere_sheets(*sphere, id, masked, splitter.column(), sheets);
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
