#include "raytrace/precision/visibility.h"

#include "raytrace/bvh/wide_single.h"
#include "raytrace/precision/ambiguous_ray.h"

namespace gnomon::raytrace {
namespace {

/// A triangle that the ray may or may not intersect. When the ambiguity is about one edge alone, the
/// neighbour across it may resolve it.
struct AmbiguousTriangle {
  std::uint32_t triangle;
  int edge;  ///< from corner `edge` to the next; -1: more than one, or the distance is ambiguous, or it has a mask
  bool positive;  ///< the projected winding, known when edge >= 0
};

class Query {
 public:
  /// exact: none, or what decides every ambiguity.
  Query(const Structures& s, const WideTree* tree, const Ray& ray, const AmbiguousRay& ambiguous,
        const ExactShadow* exact = nullptr)
      : s_(s), tree_(tree), given_(ray), ambiguous_(ambiguous), exact_(exact) {}

  template <bool masks>
  PointVisibility run(LeavesAmong among) {
    for (const std::uint32_t plane : s_.planes)
      if (plane != ambiguous_.from().primitive &&
          count<masks>(plane, ambiguous_.intersects_plane(plane), -1, false))
        return PointVisibility::shadowed;
    const auto visit_leaf = [&](std::uint32_t i) { return visit<masks>(i); };
    bool sure = false;
    if (among != nullptr) {
      sure = std::any_of(among->begin(), among->end(), visit_leaf);
    } else {
      sure = traverse_all(visit_leaf);
    }
    if (sure || (ambiguous_count_ > 0 && neighbours_cover())) return PointVisibility::shadowed;
    return ambiguous_count_ > 0 ? PointVisibility::uncertain : PointVisibility::lit;
  }

 private:
  /// Is how many triangles may meet at a corner: were one forgotten, the answer would depend on the order in which the
  /// structure reports them.
  static constexpr std::size_t remembered_triangles = 64;

  /// The floats of the wide tree leave out no triangle that intersects_triangle() would not
  /// (raytrace/bvh/wide_ray.h).
  template <class Visit>
  bool traverse_all(const Visit& visit_leaf) const {
    if (tree_ != nullptr) {
      const auto visit_one = [&](std::uint32_t leaf, WideRay&) { return visit_leaf(leaf); };
      Ray ray = given_;
      ray.t.max = ambiguous_.surely_out() / ambiguous_.frame().kernel_t_from_t;
      const WideTraversal traversed =
          visit_candidates(*tree_, ray, {.origin_error = max_component(ambiguous_.error())}, visit_one);
      if (traversed != WideTraversal::refused) return traversed == WideTraversal::ended;
    }
    BoxRay boxes(ambiguous_.frame(), s_.bvh.center, ambiguous_.error());
    boxes.t_max = float_above(ambiguous_.surely_out());
    NoStats stats;
    return traverse(s_, boxes, stats, visit_leaf);
  }

  // True ends the traversal: a sure hit.
  template <bool masks>
  bool visit(std::uint32_t index) {
    const std::uint32_t id = s_.bvh.id_at(index);
    if (s_.has_shapes && !s_.world->is_triangle(id))
      return count<masks>(id, ambiguous_.intersects_shape(id), -1, false);
    const LeafPrimitive triangle = leaf_at(s_, index);
    const ShearedTriangle t = shear(ambiguous_.frame(), triangle);
    if (ambiguous_.clearly_misses(t)) return false;
    if (id == ambiguous_.from().primitive) return false;
    int edge = -1;
    const Intersects intersects = ambiguous_.intersects_triangle(t, triangle, edge);
    if (intersects == Intersects::no ||
        (intersects == Intersects::perhaps && !ambiguous_.passes_box(triangle)))
      return false;
    return count<masks>(id, intersects, edge, t.u + t.v + t.w > 0.0);
  }

  // Records what was hit; true for a sure hit.
  template <bool masks>
  bool count(std::uint32_t id, Intersects intersects, int edge, bool positive) {
    if (intersects == Intersects::no) return false;
    if (intersects == Intersects::perhaps) {
      const bool decides = exact_ != nullptr && exact_->decides(id);
      if (!(decides && ambiguous_.takes_receiver()) && ambiguous_.below_horizon(id)) return false;
      if (decides ? !exact_->blocks(id) : ambiguous_.beyond_light(id)) return false;
      if (decides) intersects = Intersects::surely;
    }
    if constexpr (masks) {
      if (!is_opaque_here(id)) return false;
    }
    if (intersects == Intersects::surely) return true;
    // A structure may report a primitive twice.
    for (std::size_t i = 0; i < std::min(ambiguous_count_, remembered_triangles); ++i)
      if (triangles_[i].triangle == id) return false;
    if constexpr (masks)
      if (s_.world->is_masked(id)) edge = -1;  // it may have a hole where its neighbour ends
    if (ambiguous_count_ < remembered_triangles) triangles_[ambiguous_count_] = {id, edge, positive};
    ++ambiguous_count_;
    return false;
  }

  // The mask where the ray itself intersects the primitive; an ambiguous one that it just misses is kept as
  // ambiguous.
  bool is_opaque_here(std::uint32_t id) const {
    const World& world = *s_.world;
    const RayFrame& ray = ambiguous_.frame();
    if (!casts_shadow(s_, id)) return false;
    if (!world.is_masked(id)) return true;
    Hit hit;
    hit.primitive = id;
    bool intersected = false;
    if (world.is_triangle(id)) {
      const auto [a, b, c] = world.corners(id);
      TriangleHit t;
      intersected = intersect_triangle(ray, {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}}, t);
      if (intersected) hit.t = t.t, hit.barycentric = Vec2(t.b1, t.b2);
    } else if (const auto* sphere = std::get_if<Sphere>(&world.shape(id).geometry)) {
      intersected = intersect_sphere(
          ray, {{sphere->center.x, sphere->center.y, sphere->center.z, sphere->radius}}, hit.t);
    } else if (is_solid(world.shape(id).geometry)) {
      intersected = intersect_solid(ray, world.shape(id).geometry, hit.t);
    } else {
      intersected = intersect_plane(s_, ray, id, hit);
    }
    return !intersected || passes_alpha_test(s_, ray, hit);
  }

  // Two triangles that share the only edge ambiguous, one on each side of it: whatever the edge's exact
  // place, one of them is hit.
  bool neighbours_cover() const {
    const std::size_t n = std::min(ambiguous_count_, remembered_triangles);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        if (triangles_[i].edge >= 0 && triangles_[j].edge >= 0 && covers(triangles_[i], triangles_[j]))
          return true;
    return false;
  }
  bool covers(const AmbiguousTriangle& a, const AmbiguousTriangle& b) const {
    const auto edge = [&](const AmbiguousTriangle& d) {
      const auto corners = s_.world->corners(d.triangle);
      const auto k = static_cast<std::size_t>(d.edge);
      return std::array<Vec3, 2>{corners[k], corners[(k + 1) % 3]};
    };
    const auto [p, q] = edge(a);
    const auto [r, t] = edge(b);
    return a.positive == b.positive ? (p == t && q == r) : (p == r && q == t);
  }

  const Structures& s_;
  const WideTree* tree_;
  const Ray& given_;
  const AmbiguousRay& ambiguous_;
  const ExactShadow* exact_;
  std::size_t ambiguous_count_ = 0;
  std::array<AmbiguousTriangle, remembered_triangles> triangles_;
};

/// What the floats of the wide tree know: a sure answer for most rays, and what else may be intersected for
/// the others. Where masks are, nothing is sure. False: the candidates are not known.
bool ask_floats(const Structures& s, const WideTree& tree, const SurfacePoint& from, const Ray& ray,
                bool exact, std::optional<PointVisibility>& answer, LeafCandidates& found,
                LastBlocker* last) {
  if (s.has_masks) return false;
  const Vec3 error = origin_error(from, ray);
  const TraversalLimits limits{.origin_error = max_component(error),
                               .beyond = exact ? beyond_end(error, ray) : 0.0};
  const WideTraversal traversed = ambiguous_candidates(tree, ray, limits, from.primitive, found, last);
  if (traversed == WideTraversal::ended) answer = PointVisibility::shadowed;
  const auto is_left = [&](std::uint32_t plane) {
    return plane == from.primitive ||
           clearly_leaves(std::get<Plane>(s.world->shape(plane).geometry), ray, error);
  };
  if (traversed == WideTraversal::done && found.count == 0 &&
      std::all_of(s.planes.begin(), s.planes.end(), is_left))
    answer = PointVisibility::lit;
  return traversed != WideTraversal::refused;
}

PointVisibility ask(const Structures& s, const SurfacePoint& from, const Ray& ray, LeavesAmong among,
                    const ExactShadow* exact, LastBlocker* last) {
  const WideTree* tree = among == nullptr ? wide_tree(s) : nullptr;
  LeafCandidates found;
  std::span<const std::uint32_t> some;
  if (tree != nullptr) {
    std::optional<PointVisibility> answer;
    if (ask_floats(s, *tree, from, ray, exact != nullptr, answer, found, last))
      some = {found.leaf.data(), found.count}, among = &some;
    if (answer) return *answer;
  }
  RayFrame frame;
  if (!scale_ray(ray, frame))
    return PointVisibility::lit;  // the light lies within the point's own error bound
  shear_ray(frame);
  const AmbiguousRay ambiguous(*s.world, from, ray, frame, exact != nullptr);
  Query query(s, tree, ray, ambiguous, exact);
  return s.has_masks ? query.run<true>(among) : query.run<false>(among);
}

}  // namespace

PointVisibility point_visibility(const Structures& structures, const SurfacePoint& from, const Ray& ray,
                                 LeavesAmong among, LastBlocker* last) {
  return ask(structures, from, ray, among, nullptr, last);
}

PointVisibility certified_visibility(const Structures& structures, const SurfacePoint& from, const Ray& ray,
                                     const Light& light, LeavesAmong among, LastBlocker* last) {
  const ExactShadow exact(*structures.world, from, light);
  return ask(structures, from, ray, among, &exact, last);
}

}  // namespace gnomon::raytrace
