#include "scene/files/parts.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "scene/shapes/solid.h"
#include "scene/shapes/weld.h"

namespace gnomon {
namespace {

constexpr double thin = 0.15;        // of the middle extent
constexpr double small = 0.5;        // of what is set aside: what is looked at is no larger
constexpr double shell_share = 0.8;  // of a shell's extent along every axis
constexpr double not_lost = 0.02;    // of a shell's largest extent: less inside is no reason to enter

/// Numbers the mesh's connected pieces from 0 in the order of their first triangles, one number for each triangle. A mesh
/// of very many triangles takes long to look through, and is taken for one piece.
std::vector<std::uint32_t> pieces_of(const Mesh& mesh) {
  constexpr std::size_t most_triangles = 1'000'000;
  std::vector<std::uint32_t> out(mesh.triangles.size(), 0);
  if (mesh.triangles.size() > most_triangles) return out;
  std::vector<std::uint32_t> number = welded(mesh.positions), parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 1; k < 3; ++k) parent[root(number[t[k]])] = root(number[t[0]]);
  std::vector<std::uint32_t> piece(mesh.positions.size(), no_id);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::uint32_t& of_root = piece[root(number[mesh.triangles[i][0]])];
    if (of_root == no_id) of_root = count++;
    out[i] = of_root;
  }
  return out;
}

std::array<double, 3> sorted_extents(const Aabb& box) {
  const Vec3 e = box.extent();
  std::array<double, 3> out{e.x, e.y, e.z};
  std::sort(out.begin(), out.end());
  return out;
}

double largest_extent(const Aabb& box) {
  return box.empty() ? 0.0 : sorted_extents(box)[2];
}

/// The box around the parts that cast and are not set aside.
Aabb box_of_others(const std::vector<ScenePart>& parts, const std::vector<char>& aside) {
  Aabb box;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (aside[i] == 0 && parts[i].casts) box.grow(parts[i].box);
  return box;
}

/// Whether a flat part lies level under the rest, which may sink into it a little.
bool lies_under(const Aabb& ground, const Aabb& rest) {
  const Vec3 e = ground.extent();
  return e.y <= thin * std::min(e.x, e.z) && rest.min.y >= ground.min.y - small * rest.extent().y;
}

/// Sets the largest flat parts aside, from the largest on, where what remains is small beside the least of them. Two of them
/// may be backdrops, the others are grounds: a house's walls are no less the house for being larger than its lamps.
void set_flats_aside(const std::vector<ScenePart>& parts, Subject& out) {
  std::vector<std::size_t> flat;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].flat()) flat.push_back(i);
  const auto size = [&](std::size_t i) { return sorted_extents(parts[i].box)[1]; };
  std::stable_sort(flat.begin(), flat.end(), [&](auto a, auto b) { return size(a) > size(b); });
  constexpr std::ptrdiff_t most_backdrops = 2;
  std::vector<char> aside = out.aside;
  for (std::size_t begin = 0, end = 0; begin < flat.size(); begin = end) {
    constexpr double alike = 0.99;
    for (; end < flat.size() && size(flat[end]) >= alike * size(flat[begin]); ++end) aside[flat[end]] = 1;
    const Aabb rest = box_of_others(parts, aside);
    if (rest.empty()) return;
    const auto backdrops = std::count_if(flat.begin(), flat.begin() + static_cast<std::ptrdiff_t>(end),
                                         [&](std::size_t i) { return !lies_under(parts[i].box, rest); });
    if (backdrops > most_backdrops) return;
    if (largest_extent(rest) > small * size(flat[begin])) continue;
    out.aside = aside, out.box = rest, out.anything = true;
  }
}

bool holds_box(const Aabb& outer, const Aabb& inner) {
  const Vec3 more = outer.extent() - inner.extent();
  return glm::clamp(inner.min, outer.min, outer.max) == inner.min &&
         glm::clamp(inner.max, outer.min, outer.max) == inner.max && more.x >= 0.0 && more.y >= 0.0 &&
         more.z >= 0.0;
}

/// Whether nothing of the part lies in the middle of its box, as a room's and a dome's walls leave it free.
bool is_hollow(const SceneParts& scene, std::size_t part) {
  constexpr double middle = 0.2;  // of the extent, to either side of the box's middle
  const Aabb& box = scene.all()[part].box;
  const Vec3 low = box.center() - middle * box.extent(), high = box.center() + middle * box.extent();
  bool hollow = true;
  scene.visit_triangles([&](const PlacedTriangle& t, std::uint32_t of) {
    if (of != part || !hollow) return;
    const Vec3 from = glm::min(t.a, glm::min(t.b, t.c)), to = glm::max(t.a, glm::max(t.b, t.c));
    hollow =
        from.x > high.x || from.y > high.y || from.z > high.z || to.x < low.x || to.y < low.y || to.z < low.z;
  });
  return hollow;
}

/// The one part that is no flat one and holds all others, which are clearly smaller and not lost in it.
void set_shell_aside(const SceneParts& scene, Subject& out) {
  const std::vector<ScenePart>& parts = scene.all();
  std::size_t shell = 0;
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].box.diagonal() > parts[shell].box.diagonal()) shell = i;
  if (parts.size() < 2 || out.aside[shell] != 0 || parts[shell].flat()) return;
  std::vector<char> aside = out.aside;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (i == shell || parts[i].flat()) aside[i] = 1;
  const Aabb rest = box_of_others(parts, aside), &box = parts[shell].box;
  if (rest.empty() || !holds_box(box, rest) || largest_extent(rest) < not_lost * largest_extent(box)) return;
  const Vec3 most = shell_share * box.extent(), is = rest.extent();
  if (is.x > most.x || is.y > most.y || is.z > most.z || !is_hollow(scene, shell)) return;
  out.aside = aside, out.box = rest, out.anything = out.in_shell = true;
}

}  // namespace

bool ScenePart::flat() const {
  if (box.empty()) return false;
  const auto e = sorted_extents(box);
  return e[0] <= thin * e[1];
}

Aabb box_of(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
    return {sphere->center - Vec3(sphere->radius), sphere->center + Vec3(sphere->radius)};
  return world_box(shape.geometry);
}

SceneParts::SceneParts(const Scene& scene) : scene_(&scene), pieces_(scene.meshes.size()) {
  std::vector<std::uint32_t> count(scene.meshes.size());
  parallel_for(scene.meshes.size(), [&](std::size_t i) {
    pieces_[i] = pieces_of(scene.meshes[i]);
    for (const std::uint32_t piece : pieces_[i]) count[i] = std::max(count[i], piece + 1);
  });
  first_.push_back(0);
  for (const MeshInstance& instance : scene.instances) first_.push_back(first_.back() + count[instance.mesh]);
  parts_.resize(first_.back());
  visit_triangles([&](const PlacedTriangle& t, std::uint32_t part) {
    ScenePart& of = parts_[part];
    of.box.grow(t.a), of.box.grow(t.b), of.box.grow(t.c);
    of.casts = of.casts || scene.materials[t.material].casts_shadow;
  });
  visit_shapes([&](const Shape& shape, std::uint32_t) {
    parts_.push_back({box_of(shape), scene.materials[shape.material].casts_shadow});
  });
}

Subject find_subject(const SceneParts& parts, bool with_shell) {
  Subject out;
  out.aside.assign(parts.all().size(), 0);
  out.box = box_of_others(parts.all(), out.aside);
  set_flats_aside(parts.all(), out);
  if (with_shell) set_shell_aside(parts, out);
  return out;
}

}  // namespace gnomon
