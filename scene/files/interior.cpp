#include "scene/files/defaults.h"

#include <algorithm>
#include <array>

#include "scene/files/polygon.h"

namespace gnomon {
namespace {

constexpr int cells = 32;             // on a side of the grid that a side's faces are drawn into
constexpr double near_share = 0.1;    // of the room's extent: walls have some thickness
constexpr double flat = 0.95;         // |n| along the axis of a face that lies in a side
constexpr double closed_share = 0.7;  // of a side: the rest may be windows and doors

/// One side of the box: which cells of it some face covers, and which one that faces inwards.
class Side {
 public:
  Side(const Aabb& box, int axis, bool high) : box_(box), axis_(axis), high_(high) {}

  /// Whether the triangle, which lies flat across the axis, lies in the side.
  bool holds(const PlacedTriangle& t) const {
    return depth(t.a) <= near_share && depth(t.b) <= near_share && depth(t.c) <= near_share;
  }
  void draw(const PlacedTriangle& t) { draw(t, (t.normal()[axis_] > 0.0) != high_); }
  void add(const Side& more) {
    for (std::size_t i = 0; i < cell_.size(); ++i) cell_[i] = static_cast<char>(cell_[i] | more.cell_[i]);
  }
  double covered() const { return share(1); }
  double covered_inwards() const { return share(2); }

 private:
  double depth(const Vec3& p) const {
    const double at = (p[axis_] - box_.min[axis_]) / box_.extent()[axis_];
    return high_ ? 1.0 - at : at;
  }
  Vec2 in_cells(const Vec3& p) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    return {cells * (p[u] - box_.min[u]) / box_.extent()[u], cells * (p[v] - box_.min[v]) / box_.extent()[v]};
  }

  /// The cells whose middles the triangle covers.
  void draw(const PlacedTriangle& t, bool inwards) {
    const std::array<Vec2, 3> p{in_cells(t.a), in_cells(t.b), in_cells(t.c)};
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; };
    const auto first = [](double least) { return std::max(0, static_cast<int>(std::floor(least))); };
    const auto last = [](double most) { return std::min(cells - 1, static_cast<int>(std::floor(most))); };
    const double turn = cross(p[1] - p[0], p[2] - p[0]) < 0.0 ? -1.0 : 1.0;
    const int right = last(std::max({p[0].x, p[1].x, p[2].x})),
              top = last(std::max({p[0].y, p[1].y, p[2].y}));
    for (int y = first(std::min({p[0].y, p[1].y, p[2].y})); y <= top; ++y)
      for (int x = first(std::min({p[0].x, p[1].x, p[2].x})); x <= right; ++x) {
        const Vec2 middle(x + 0.5, y + 0.5);
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i)
          inside = inside && turn * cross(p[(i + 1) % 3] - p[i], middle - p[i]) >= 0.0;
        char& cell = cell_[static_cast<std::size_t>(y) * cells + static_cast<std::size_t>(x)];
        if (inside) cell = static_cast<char>(cell | (inwards ? 3 : 1));
      }
  }
  double share(char bit) const {
    return static_cast<double>(
               std::count_if(cell_.begin(), cell_.end(), [&](char c) { return (c & bit) != 0; })) /
           (cells * cells);
  }

  Aabb box_;
  int axis_;
  bool high_;
  std::array<char, std::size_t{cells} * cells> cell_{};
};

bool shines_inside(const Scene& scene, const Aabb& box) {
  const auto inside = [&](const Vec3& p) {
    return p.x > box.min.x && p.y > box.min.y && p.z > box.min.z && p.x < box.max.x && p.y < box.max.y &&
           p.z < box.max.z;
  };
  return std::any_of(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    return light.type != LightType::directional && inside(light.position);
  });
}

/// What of the scene is a room's.
struct Walls {
  std::vector<Side> sides;
  bool lamp =
      false;  ///< something glows inside: what glows on the outside of a body's single-sided faces is none
  bool dull = false;  ///< some wall does not glow; where all do, the whole is a glowing body
  void add(const Scene& scene, const PlacedTriangle& t) {
    const Vec3 normal = t.normal();
    const double least = flat * glm::length(normal);
    const Material& material = scene.materials[t.material];
    const bool glows = material.emission != Vec3f(0.0f);
    bool outside = false;
    for (int axis = 0; axis < 3 && least > 0.0; ++axis) {
      if (std::abs(normal[axis]) < least) continue;
      for (const bool high : {false, true}) {
        Side& side = sides[static_cast<std::size_t>(2 * axis) + (high ? 1 : 0)];
        if (!side.holds(t)) continue;
        side.draw(t);
        dull = dull || !glows;
        outside = outside || ((normal[axis] > 0.0) == high && !shows_back(material));
      }
    }
    lamp = lamp || (glows && !outside);
  }
  void join(const Walls& more) {
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i].add(more.sides[i]);
    lamp = lamp || more.lamp, dull = dull || more.dull;
  }
};

bool is_room(const Scene& scene, const Aabb& box) {
  Walls none;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) none.sides.emplace_back(box, axis, high);
  const Walls walls = over_placed_triangles(
      scene, none, [&](Walls& sum, const PlacedTriangle& t) { sum.add(scene, t); },
      [](Walls& sum, const Walls& more) { sum.join(more); });
  const auto all = [&](double (Side::*share)() const) {
    return std::all_of(walls.sides.begin(), walls.sides.end(),
                       [&](const Side& side) { return (side.*share)() >= closed_share; });
  };
  return all(&Side::covered) &&
         (all(&Side::covered_inwards) || (walls.lamp && walls.dull) || shines_inside(scene, box));
}

/// The part of the way from one point to another that is free of the triangle, up to 1.
double free_part(const PlacedTriangle& t, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const Vec3 normal = t.normal();
  const double along = glm::dot(normal, way);
  if (along == 0.0) return 1.0;
  const double at = glm::dot(normal, t.a - from) / along;
  if (!(at >= 0.0 && at < 1.0)) return 1.0;
  const Vec3 p = from + at * way;
  for (const auto& [a, b] : {std::pair{t.a, t.b}, {t.b, t.c}, {t.c, t.a}})
    if (!(glm::dot(glm::cross(b - a, p - a), normal) >= 0.0)) return 1.0;
  return at;
}

/// The first point that is `clear` of everything and sees half of the way to the target, else the best. Of many
/// triangles some are looked at.
Vec3 clearest(const Scene& scene, const std::vector<Vec3>& points, const Vec3& target, double clear) {
  constexpr std::size_t enough = 500000;
  std::size_t count = 0, at = 0;
  for (const MeshInstance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
  const std::size_t step = std::max<std::size_t>(1, count / enough);
  std::vector<double> near(points.size(), clear), free(points.size(), 0.5);
  const auto look = [&](const PlacedTriangle& t) {
    if (at++ % step != 0) return;
    const Vec3 low = glm::min(t.a, glm::min(t.b, t.c)), high = glm::max(t.a, glm::max(t.b, t.c));
    for (std::size_t i = 0; i < points.size(); ++i) {
      near[i] = std::min(near[i], glm::distance(points[i], glm::clamp(points[i], low, high)));
      free[i] = std::min(free[i], free_part(t, points[i], target));
    }
  };
  for (const MeshInstance& instance : scene.instances)
    visit_placed(scene, instance, 0, scene.meshes[instance.mesh].triangles.size(), look);
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (near[i] * free[i] > near[best] * free[best]) best = i;
  return points[best];
}

}  // namespace

std::optional<Interior> find_interior(const Scene& scene, const Aabb& bounds) {
  const Vec3 extent = bounds.extent();
  if (bounds.empty() || !(extent.x > 0.0 && extent.y > 0.0 && extent.z > 0.0) || !is_room(scene, bounds))
    return std::nullopt;
  const auto place = [&](double x, double y, double z) { return bounds.min + extent * Vec3(x, y, z); };
  constexpr double eye_height = 0.55, lamp_height = 0.85, inset = 0.15;
  std::vector<Vec3> eyes, lamps;
  for (const Vec2& at : {Vec2(0.5, 1.0 - inset), Vec2(1.0 - inset, 1.0 - inset), Vec2(inset, 1.0 - inset),
                         Vec2(1.0 - inset, 0.5), Vec2(inset, 0.5), Vec2(0.5, inset)})
    eyes.push_back(place(at.x, eye_height, at.y));
  for (const Vec2& at : {Vec2(0.5), Vec2(0.5, 0.65), Vec2(0.65, 0.5), Vec2(0.35, 0.5), Vec2(0.5, 0.35)})
    lamps.push_back(place(at.x, lamp_height, at.y));
  const double clear = 0.04 * bounds.diagonal();
  Interior out;
  out.camera.target = place(0.5, 0.45, 0.5);
  out.camera.eye = clearest(scene, eyes, out.camera.target, clear);
  out.camera.vertical_fov = 70.0 * pi / 180.0;
  out.lamp = clearest(scene, lamps, out.camera.target, 0.5 * clear);
  return out;
}

}  // namespace gnomon
