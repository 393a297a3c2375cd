// Rooms: where one stands in them to see what is in them, and where their lamp hangs.
#include <algorithm>
#include <array>

#include "scene/files/made_view.h"
#include "scene/files/sketch.h"

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

Walls walls_of(const Scene& scene, const Aabb& box) {
  Walls none;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) none.sides.emplace_back(box, axis, high);
  return over_placed_triangles(
      scene, none, [&](Walls& sum, const PlacedTriangle& t) { sum.add(scene, t); },
      [](Walls& sum, const Walls& more) { sum.join(more); });
}

/// By part, whether it stands free in the room: it is no wall of it, and none divides it.
std::vector<char> contents_of(const SceneParts& parts, const Aabb& box) {
  constexpr double most = 0.8;  // of the room's extent, along every axis
  std::vector<char> out;
  for (const ScenePart& part : parts.all()) {
    const Vec3 room = box.extent(), is = part.box.extent();
    const bool within = glm::clamp(part.box.center(), box.min, box.max) == part.box.center();
    const Vec3 from_low = (part.box.max - box.min) / room, from_high = (box.max - part.box.min) / room;
    const bool in_side =
        std::min({from_low.x, from_low.y, from_low.z, from_high.x, from_high.y, from_high.z}) <= near_share;
    out.push_back(static_cast<char>(part.casts && within && !in_side && !part.flat() &&
                                    is.x <= most * room.x && is.y <= most * room.y && is.z <= most * room.z));
  }
  return out;
}

/// Whether no eye outside sees what is in the box.
bool hides(const Scene& scene, const SceneParts& parts, const Aabb& box, const std::vector<char>& contents) {
  constexpr double hidden = 0.1;  // of what would be seen without the walls
  const auto counts = [&](std::uint32_t part) { return contents[part] != 0; };
  for (const Vec3& back : {Vec3(0.55, 0.5, 1.0), Vec3(-0.55, 0.5, -1.0), Vec3(0.1, 1.0, 0.2)})
    if (seen_share(scene, parts, framed(box, back), counts) > hidden) return false;
  return true;
}

/// One of Walls::sides, or -1 of a room that is closed all around; none: it is no room.
std::optional<int> open_side(const Scene& scene, const SceneParts& parts, const Aabb& box,
                             const std::vector<char>& contents) {
  constexpr double open_share = 0.3;  // of the side that is covered at most
  constexpr int bottom = 2;
  const Walls walls = walls_of(scene, box);
  int open = -1;
  bool inwards = true;
  for (int i = 0; i < 6; ++i) {
    const Side& side = walls.sides[static_cast<std::size_t>(i)];
    if (side.covered() >= closed_share) {
      inwards = inwards && side.covered_inwards() >= closed_share;
    } else {
      if (open >= 0 || i == bottom || side.covered() > open_share) return std::nullopt;
      open = i;
    }
  }
  if (inwards || (walls.lamp && walls.dull) || shines_inside(scene, box)) return open;
  const bool holds_some = std::any_of(contents.begin(), contents.end(), [](char c) { return c != 0; });
  if (!holds_some || (open < 0 && !hides(scene, parts, box, contents))) return std::nullopt;
  return open;
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

/// How free places are, and the ways from them to targets.
struct Freedom {
  std::vector<double> near;               ///< by place: how far everything is, up to what is asked for
  std::vector<std::vector<double>> free;  ///< by place and target: the free part of the way, up to half of it
};

/// Of many triangles some are looked at.
Freedom freedom(const Scene& scene, const std::vector<Vec3>& places, const std::vector<Vec3>& targets,
                double clear) {
  constexpr std::size_t enough = 500000;
  std::size_t count = 0, at = 0;
  for (const MeshInstance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
  const std::size_t step = std::max<std::size_t>(1, count / enough);
  Freedom out{std::vector<double>(places.size(), clear), {}};
  out.free.assign(places.size(), std::vector<double>(targets.size(), 0.5));
  const auto look = [&](const PlacedTriangle& t) {
    if (at++ % step != 0) return;
    const Vec3 low = glm::min(t.a, glm::min(t.b, t.c)), high = glm::max(t.a, glm::max(t.b, t.c));
    for (std::size_t i = 0; i < places.size(); ++i) {
      out.near[i] = std::min(out.near[i], glm::distance(places[i], glm::clamp(places[i], low, high)));
      for (std::size_t k = 0; k < targets.size(); ++k)
        out.free[i][k] = std::min(out.free[i][k], free_part(t, places[i], targets[k]));
    }
  };
  for (const MeshInstance& instance : scene.instances)
    visit_placed(scene, instance, 0, scene.meshes[instance.mesh].triangles.size(), look);
  return out;
}

/// The first place that is `clear` of everything and sees half of the way to all targets, else the best.
Vec3 clearest(const Scene& scene, const std::vector<Vec3>& places, const std::vector<Vec3>& targets,
              double clear) {
  const Freedom found = freedom(scene, places, targets, clear);
  const auto worth = [&](std::size_t i) {
    double product = found.near[i];
    for (const double free : found.free[i]) product *= free;
    return product;
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
    if (worth(i) > worth(best)) best = i;
  return places[best];
}

/// How well a camera shows what is in the room, worst where that is cut off; of an empty room, how far it sees.
double usefulness(const Scene& scene, const SceneParts& parts, const Camera& camera, double diagonal,
                  const std::vector<char>& contents) {
  constexpr double enough = 0.04, least = 0.002;  // of the picture
  constexpr double cut_off = 0.3;
  Sketch sketch(make_view(camera, sketch_size));
  sketch.draw(scene, parts, true, false, [](std::uint32_t) { return true; });
  const auto counts = [&](std::uint32_t part) { return contents[part] != 0; };
  if (std::any_of(contents.begin(), contents.end(), [](char c) { return c != 0; }))
    return (least + std::min(enough, sketch.share(counts))) * (sketch.cuts(counts) ? cut_off : 1.0);
  double sum = 0.0;
  for (const double depth : sketch.depths()) sum += std::min(depth, diagonal);
  return sum;
}

/// The first of the cameras at these eyes that is about as good as any.
Camera chosen_inside(const Scene& scene, const SceneParts& parts, const std::vector<Vec3>& eyes,
                     const std::vector<Vec3>& targets, double diagonal, const std::vector<char>& contents) {
  constexpr double clear_share = 0.04;  // of the diagonal
  constexpr double as_good = 0.6, worth_a_look = 0.5;
  const Freedom found = freedom(scene, eyes, targets, clear_share * diagonal);
  std::vector<std::pair<double, Camera>> cameras;
  double freest = 0.0, best = 0.0;
  for (std::size_t k = 0; k < targets.size(); ++k)
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      Camera camera;
      camera.eye = eyes[i], camera.target = targets[k], camera.vertical_fov = 70.0 * pi / 180.0;
      cameras.emplace_back(found.near[i] * found.free[i][k], camera);
      freest = std::max(freest, cameras.back().first);
    }
  for (auto& [worth, camera] : cameras) {
    worth *= worth >= worth_a_look * freest ? usefulness(scene, parts, camera, diagonal, contents) : 0.0;
    best = std::max(best, worth);
  }
  return std::find_if(cameras.begin(), cameras.end(),
                      [&](const auto& c) { return c.first >= as_good * best; })
      ->second;
}

}  // namespace

std::optional<Interior> find_interior(const Scene& scene, const SceneParts& parts, const Aabb& bounds) {
  const Vec3 extent = bounds.extent();
  if (bounds.empty() || !(extent.x > 0.0 && extent.y > 0.0 && extent.z > 0.0)) return std::nullopt;
  Interior out;
  out.contents = contents_of(parts, bounds);
  const auto open = open_side(scene, parts, bounds, out.contents);
  if (!open) return std::nullopt;
  constexpr int top = 3;
  if (*open >= 0) out.open[*open / 2] = *open % 2 == 0 ? -1.0 : 1.0;
  const auto place = [&](double x, double y, double z) { return bounds.min + extent * Vec3(x, y, z); };
  constexpr double eye_height = 0.55, target_height = 0.45, lamp_height = 0.85, inset = 0.15;
  std::vector<Vec3> eyes, targets{place(0.5, target_height, 0.5)}, lamps;
  for (const Vec2& at : {Vec2(0.5, 1.0 - inset), Vec2(1.0 - inset, 1.0 - inset), Vec2(inset, 1.0 - inset),
                         Vec2(1.0 - inset, 0.5), Vec2(inset, 0.5), Vec2(0.5, inset)})
    eyes.push_back(place(at.x, eye_height, at.y));
  for (const Vec2& at : {Vec2(0.75, 0.5), Vec2(0.25, 0.5), Vec2(0.5, 0.25), Vec2(0.5, 0.75)})
    targets.push_back(place(at.x, target_height, at.y));
  Aabb standing;
  for (std::size_t i = 0; i < out.contents.size(); ++i)
    if (out.contents[i] != 0) standing.grow(parts.all()[i].box);
  if (!standing.empty()) targets.push_back(standing.center());
  if (*open < 0) {
    out.camera = chosen_inside(scene, parts, eyes, targets, bounds.diagonal(), out.contents);
  } else {
    out.camera = framed(bounds, *open == top ? Vec3(0.3, 1.2, 0.7) : out.open);
  }
  if (*open == top) return out;
  const Vec3 eye = *open < 0 ? out.camera.eye : out.camera.target;
  for (const Vec2& at : {Vec2(0.5), Vec2(0.5, 0.65), Vec2(0.65, 0.5), Vec2(0.35, 0.5), Vec2(0.5, 0.35)})
    lamps.push_back(place(at.x, lamp_height, at.y));
  for (const double way : {0.3, 0.5}) {
    Vec3 above = glm::mix(out.camera.target, eye, way);
    above.y = lamps.front().y;
    lamps.push_back(above);
  }
  out.lamp = clearest(scene, lamps, {out.camera.target, eye}, 0.02 * bounds.diagonal());
  return out;
}

}  // namespace gnomon
