#include "lab/lessons/figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <optional>

#include "raytrace/accel/any_structure.h"
#include "scene/load.h"

namespace gnomon::lab::lessons {

namespace {

using Json = nlohmann::ordered_json;
using raytrace::Accel;

constexpr double plane_z = 0.0137;  // world units: through no vertex and along no wall of a built-in scene
constexpr int check_rays = 12;

std::optional<Accel> accel_of(const std::string& kind) {
  if (kind == "grid") return Accel::grid;
  if (kind == "octree") return Accel::octree;
  if (kind == "kd") return Accel::kdtree;
  if (kind == "bsp") return Accel::bsp;
  if (kind == "bvh") return Accel::bvh_median;
  return std::nullopt;
}

/// In ascending order: in a leaf of boxes they lie as their builder's library left them.
Json ranges_of(std::span<const std::uint32_t> of_cell) {
  std::vector<std::uint32_t> items(of_cell.begin(), of_cell.end());
  std::sort(items.begin(), items.end());
  Json ranges = Json::array();
  for (std::size_t i = 0; i < items.size();) {
    std::size_t end = i + 1;
    while (end < items.size() && items[end] == items[end - 1] + 1) ++end;
    ranges.push_back(items[i]), ranges.push_back(items[end - 1]);
    i = end;
  }
  return ranges;
}

using Polygon = std::vector<Vec2>;

/// The part of a polygon on which normal . p <= offset.
Polygon clipped(const Polygon& polygon, const Vec2& normal, double offset) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double from = glm::dot(normal, a) - offset, to = glm::dot(normal, b) - offset;
    if (from <= 0.0) part.push_back(a);
    if ((from <= 0.0) != (to <= 0.0)) part.push_back(a + (b - a) * (from / (from - to)));
  }
  return part;
}

/// The structures count from the centre of the world's bounds.
class StructureCut {
 public:
  StructureCut(const Vec3& center, const raytrace::CellBox& box)
      : center_(center), z_(plane_z - center.z), box_(box) {}

  Json operator()(const raytrace::KdTree& tree) const { return tree.nodes.empty() ? Json() : kd(tree, 0); }
  Json operator()(const raytrace::Octree& tree) const {
    return tree.nodes.empty() ? Json() : octree(tree, 0);
  }
  Json operator()(const raytrace::MedianBvh& tree) const {
    return tree.nodes.empty() ? Json() : bvh(tree, 0);
  }
  Json operator()(const raytrace::BspTree& tree) const {
    if (tree.leaves.empty()) return {};
    // How far from a plane a ray that begins within three widths of the scene may still seem to be on its other side
    // (PlaneRay, raytrace/accel/bsp.h), with room to spare.
    double width = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) width += box_.max[axis] - box_.min[axis];
    const double doubt = tree.plane_slack + 32.0 * FLT_EPSILON * width;
    const double left = box_.min[0] - doubt, right = box_.max[0] + doubt, bottom = box_.min[1] - doubt,
                 top = box_.max[1] + doubt;
    return bsp(tree, tree.root, {{left, bottom}, {right, bottom}, {right, top}, {left, top}}, doubt);
  }
  Json operator()(const raytrace::UniformGrid& grid) const {
    std::size_t slice = 0;
    while (slice + 1 < static_cast<std::size_t>(grid.cells[2]) && grid.walls[2][slice + 1] <= z_) ++slice;
    Json walls = Json::array(), rows = Json::array();
    for (std::size_t axis = 0; axis < 2; ++axis) {
      walls.push_back(Json::array());
      for (const float wall : grid.walls[axis]) walls.back().push_back(world(axis, wall));
    }
    for (int y = 0; y < grid.cells[1]; ++y) {
      rows.push_back(Json::array());
      for (int x = 0; x < grid.cells[0]; ++x)
        rows.back().push_back(ranges_of(grid.cell(grid.index(x, y, static_cast<int>(slice)))));
    }
    return {{"walls", walls}, {"cells", rows}};
  }
  template <class Other>
  Json operator()(const Other&) const {
    return {};
  }

  Json bounds(const raytrace::CellBox& box) const {
    return {world(0, box.min[0]), world(0, box.max[0]), world(1, box.min[1]), world(1, box.max[1])};
  }

 private:
  double world(std::size_t axis, float value) const {
    return static_cast<double>(value) + center_[static_cast<int>(axis)];
  }

  template <class Tree>
  Json leaf(const Tree& tree, std::size_t first, std::size_t count) const {
    return {{"items", ranges_of(std::span(tree.items).subspan(first, count))}};
  }

  Json kd(const raytrace::KdTree& tree, std::uint32_t at) const {
    const raytrace::KdNode node = tree.nodes[at];
    if (node.is_leaf()) return leaf(tree, node.first(), node.count());
    const bool across = node.axis() == 2, right = across && z_ > node.split;
    Json children{across && right ? Json() : kd(tree, at + 1),
                  across && !right ? Json() : kd(tree, node.right())};
    Json json{{"axis", node.axis()}, {"children", std::move(children)}};
    if (!across) json["split"] = world(node.axis(), node.split);
    return json;
  }

  Json octree(const raytrace::Octree& tree, std::uint32_t at) const {
    const raytrace::OctreeNode& node = tree.nodes[at];
    if (node.is_leaf()) return leaf(tree, node.first, node.count);
    const std::uint32_t half = z_ > node.middle[2] ? 4 : 0;
    Json children = Json::array();
    for (std::uint32_t i = half; i < half + 4; ++i)
      children.push_back(tree.nodes[node.first + i].count == 0 ? Json() : octree(tree, node.first + i));
    return {{"middle", {world(0, node.middle[0]), world(1, node.middle[1])}},
            {"children", std::move(children)}};
  }

  Json bvh(const raytrace::MedianBvh& tree, std::uint32_t at) const {
    const raytrace::MedianNode& node = tree.nodes[at];
    if (z_ < node.box.min[2] || z_ > node.box.max[2]) return {{"missed", true}};
    Json json = node.count > 0 ? leaf(tree, node.first, node.count)
                               : Json{{"children", {bvh(tree, at + 1), bvh(tree, node.first)}}};
    json["box"] = bounds(node.box);
    return json;
  }

  /// `cell`: what a ray in the plane can see of it; nothing is left of one that it cannot come to.
  Json bsp(const raytrace::BspTree& tree, std::uint32_t at, const Polygon& cell, double doubt) const {
    using raytrace::BspNode;
    if (cell.empty()) return {};
    if ((at & BspNode::leaf_flag) != 0) {
      const raytrace::BspLeaf& own = tree.leaves[at & ~BspNode::leaf_flag];
      return leaf(tree, own.first, own.count);
    }
    const BspNode& node = tree.nodes[at];
    const Vec2 normal(node.normal[0], node.normal[1]);
    const double offset = node.offset - node.normal[2] * z_;  // in the plane
    Json children = Json::array();
    for (const double side : {1.0, -1.0})
      children.push_back(
          bsp(tree, node.child[side < 0.0], clipped(cell, side * normal, side * offset + doubt), doubt));
    return {{"normal", {normal.x, normal.y}},
            {"offset", offset + normal.x * center_.x + normal.y * center_.y},
            {"children", std::move(children)}};
  }

  Vec3 center_;
  double z_;
  raytrace::CellBox box_;
};

/// Where the plane cuts the triangles, by the items' places.
Json segments_of(const raytrace::CellItems& items) {
  Json segments = Json::array();
  for (std::uint32_t item = 0; item < items.count(); ++item) {
    if (!items.is_triangle(item)) continue;
    const std::array<Vec3, 3> corners = items.corners(item);
    std::vector<Vec3> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 a = corners[i] + items.center(), b = corners[(i + 1) % 3] + items.center();
      const double from = a.z - plane_z, to = b.z - plane_z;
      if ((from < 0.0) != (to < 0.0)) ends.push_back(a + (b - a) * (from / (from - to)));
    }
    if (ends.size() == 2) segments.push_back({item, ends[0].x, ends[0].y, ends[1].x, ends[1].y});
  }
  return segments;
}

/// Rays in the plane from around the scene to points within, and what the program counts for them.
Json checks_of(const raytrace::Tracer& tracer, const Json& bounds) {
  const double left = bounds[0], right = bounds[1], bottom = bounds[2], top = bounds[3];
  const Vec3 middle((left + right) / 2.0, (bottom + top) / 2.0, plane_z);
  Json checks = Json::array();
  for (int i = 0; i < check_rays; ++i) {
    const double angle = 2.0 * pi * (i + 0.37) / check_rays, reach = i % 2 == 0 ? 1.3 : 0.4;
    const Vec3 from = middle + Vec3(reach * (right - left) * std::cos(angle),
                                    reach * (top - bottom) * std::sin(angle), 0.0);
    const Vec3 to = middle + Vec3(0.11 * (right - left) * std::sin(5.0 * angle),
                                  0.17 * (top - bottom) * std::cos(3.0 * angle), 0.0);
    const Ray ray{from, glm::normalize(to - from), {}};
    raytrace::WorkCounts work;
    const auto hit = tracer.closest_hit(ray, work);
    checks.push_back({{"from", {from.x, from.y}},
                      {"to", {to.x, to.y}},
                      {"boxes", work.boxes},
                      {"primitives", work.primitives},
                      {"t", hit ? Json(hit->t) : Json()}});
  }
  return checks;
}

}  // namespace

Expected<nlohmann::ordered_json> structure_cut(const std::string& kind, const std::string& scene_name) {
  const auto accel = accel_of(kind);
  if (!accel) return fail(ErrorKind::internal, fmt::format("no such kind of structure (got {})", kind));
  const auto scene = load_scene(scene_name);
  if (!scene) return fail(scene.error());
  const World world = make_world(*scene);
  const raytrace::CellItems items(world);
  const StructureCut cut(items.center(), items.bounds());
  const raytrace::Structure structure = raytrace::build_structure(world, *accel);
  Json json{{"kind", kind}, {"scene", scene_name}, {"plane", plane_z}, {"primitives", items.count()}};
  json["bounds"] = cut.bounds(items.bounds());
  json["segments"] = segments_of(items);
  json["tree"] = std::visit(cut, structure);
  if (const auto* bsp = std::get_if<raytrace::BspTree>(&structure)) json["slack"] = bsp->plane_slack;
  json["checks"] = checks_of(raytrace::Tracer(world, *accel), json["bounds"]);
  return json;
}

}  // namespace gnomon::lab::lessons
