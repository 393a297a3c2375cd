#include "raytrace/precision/visibility.h"

#include "raytrace/bvh/wide_single.h"
#include "raytrace/precision/ambiguous_ray.h"
#include "raytrace/precision/exact_shadow.h"

namespace gnomon::raytrace {
namespace {

/// A triangle that the ray may or may not meet. When the doubt is about one edge alone, the neighbour across
/// it may resolve it.
struct Doubt {
  std::uint32_t triangle = no_id;
  int edge = -1;          ///< from corner `edge` to the next; -1: more than one, or the distance is in doubt
  bool positive = false;  ///< the projected winding, known when edge >= 0
};

class Query {
 public:
  /// exact: none, or what decides every doubt.
  Query(const Structures& s, const WideTree* tree, const Ray& ray, const DoubtfulRay& doubtful,
        const ExactShadow* exact = nullptr)
      : s_(s), tree_(tree), given_(ray), doubtful_(doubtful), exact_(exact) {}

  template <bool masks>
  Verdict run(Candidates among) {
    for (const std::uint32_t plane : s_.planes)
      if (plane != doubtful_.from().primitive && count<masks>(plane, doubtful_.meet_plane(plane), -1, false))
        return Verdict::shadowed;
    const auto visit_leaf = [&](std::uint32_t i) { return visit<masks>(i); };
    bool sure = false;
    if (among != nullptr) {
      sure = std::any_of(among->begin(), among->end(), visit_leaf);
    } else {
      sure = walk_all(visit_leaf);
    }
    if (sure || (doubts_ > 0 && neighbours_cover())) return Verdict::shadowed;
    return doubts_ > 0 ? Verdict::uncertain : Verdict::lit;
  }

 private:
  static constexpr std::size_t remembered_doubts = 8;

  /// The floats of the wide tree leave out no triangle that meet_triangle() would not
  /// (raytrace/bvh/wide_ray.h).
  template <class Visit>
  bool walk_all(const Visit& visit_leaf) const {
    if (tree_ != nullptr) {
      const auto visit_one = [&](std::uint32_t leaf, WideRay&) { return visit_leaf(leaf); };
      Ray ray = given_;
      ray.t.max = doubtful_.surely_out() / doubtful_.frame().kernel_t_from_t;
      const WideWalk walked = visit_candidates(
          *tree_, ray, {.origin_error = max_component(doubtful_.error())}, visitor_of(visit_one));
      if (walked != WideWalk::refused) return walked == WideWalk::ended;
    }
    BoxRay boxes(doubtful_.frame(), s_.bvh.center, doubtful_.error());
    boxes.t_max = float_above(doubtful_.surely_out());
    NoStats stats;
    return walk(s_, boxes, stats, visit_leaf);
  }

  // True ends the walk: a sure hit.
  template <bool masks>
  bool visit(std::uint32_t index) {
    const std::uint32_t id = s_.bvh.ids[index];
    if (s_.has_shapes && !s_.world->is_triangle(id))
      return count<masks>(id, doubtful_.meet_shape(id), -1, false);
    LeafPrimitive room;
    const LeafPrimitive& triangle = leaf_at(s_, index, room);
    const ShearedTriangle t = shear(doubtful_.frame(), triangle);
    if (doubtful_.clearly_misses(t)) return false;
    if (id == doubtful_.from().primitive) return false;
    int edge = -1;
    const Meets meets = doubtful_.meet_triangle(t, triangle, edge);
    if (meets == Meets::no || (meets == Meets::perhaps && !doubtful_.passes_box(triangle))) return false;
    return count<masks>(id, meets, edge, t.u + t.v + t.w > 0.0);
  }

  // Records what was met; true for a sure hit.
  template <bool masks>
  bool count(std::uint32_t id, Meets meets, int edge, bool positive) {
    if (meets == Meets::no) return false;
    if (meets == Meets::perhaps && exact_ != nullptr && exact_->decides(id)) {
      if (!exact_->blocks(id)) return false;
      meets = Meets::surely;
    }
    if (meets == Meets::perhaps && (doubtful_.below_horizon(id) || doubtful_.beyond_light(id))) return false;
    if constexpr (masks) {
      if (!solid_here(id)) return false;
    }
    if (meets == Meets::surely) return true;
    // A structure may offer a primitive twice.
    for (std::size_t i = 0; i < std::min(doubts_, remembered_doubts); ++i)
      if (doubt_[i].triangle == id) return false;
    if (doubts_ < remembered_doubts) doubt_[doubts_] = {id, edge, positive};
    ++doubts_;
    return false;
  }

  // The mask where the ray itself meets the primitive; a doubtful one that it just misses is kept as a doubt.
  bool solid_here(std::uint32_t id) const {
    const World& world = *s_.world;
    const RayFrame& ray = doubtful_.frame();
    if (world.scene->materials[world.material_of(id)].alpha_mode != AlphaMode::mask) return true;
    Hit hit;
    hit.primitive = id;
    bool met = false;
    if (world.is_triangle(id)) {
      const auto [a, b, c] = world.corners(id);
      TriangleHit t;
      met = intersect_triangle(ray, {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}}, t);
      if (met) hit.t = t.t, hit.barycentric = Vec2(t.b1, t.b2);
    } else if (const auto* sphere = std::get_if<Sphere>(&world.shape(id).geometry)) {
      met = intersect_sphere(ray, {{sphere->center.x, sphere->center.y, sphere->center.z, sphere->radius}},
                             hit.t);
    } else if (is_solid(world.shape(id).geometry)) {
      met = intersect_solid(ray, world.shape(id).geometry, hit.t);
    } else {
      met = intersect_plane(s_, ray, id, hit);
    }
    return !met || solid(s_, ray, hit);
  }

  // Two triangles that share the only edge in doubt, one on each side of it: whatever the edge's exact place,
  // one of them is met.
  bool neighbours_cover() const {
    const std::size_t n = std::min(doubts_, remembered_doubts);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        if (doubt_[i].edge >= 0 && doubt_[j].edge >= 0 && covers(doubt_[i], doubt_[j])) return true;
    return false;
  }
  bool covers(const Doubt& a, const Doubt& b) const {
    const auto edge = [&](const Doubt& d) {
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
  const DoubtfulRay& doubtful_;
  const ExactShadow* exact_;
  std::size_t doubts_ = 0;
  std::array<Doubt, remembered_doubts> doubt_;
};

/// What the floats of the wide tree know: a sure answer for most rays, and what else may be met for the
/// others. Where masks are, nothing is sure. False: the candidates are not known.
bool ask_floats(const Structures& s, const WideTree& tree, const SurfacePoint& from, const Ray& ray,
                bool exact, std::optional<Verdict>& answer, LeafCandidates& found) {
  if (s.has_masks) return false;
  const Vec3 error = origin_error(from, ray);
  const WalkLimits limits{.origin_error = max_component(error),
                          .beyond = exact ? beyond_end(error, ray) : 0.0};
  const WideWalk walked = doubtful_candidates(tree, ray, limits, from.primitive, found);
  if (walked == WideWalk::ended) answer = Verdict::shadowed;
  const auto is_left = [&](std::uint32_t plane) {
    return plane == from.primitive ||
           clearly_leaves(std::get<Plane>(s.world->shape(plane).geometry), ray, error);
  };
  if (walked == WideWalk::done && found.count == 0 && std::all_of(s.planes.begin(), s.planes.end(), is_left))
    answer = Verdict::lit;
  return walked != WideWalk::refused;
}

Verdict ask(const Structures& s, const SurfacePoint& from, const Ray& ray, Candidates among,
            const ExactShadow* exact) {
  const WideTree* tree = among == nullptr ? wide_tree(s) : nullptr;
  LeafCandidates found;
  std::span<const std::uint32_t> some;
  if (tree != nullptr) {
    std::optional<Verdict> answer;
    if (ask_floats(s, *tree, from, ray, exact != nullptr, answer, found))
      some = {found.leaf.data(), found.count}, among = &some;
    if (answer) return *answer;
  }
  RayFrame frame;
  if (!scale_ray(ray, frame)) return Verdict::lit;  // the light lies within the point's own error bound
  shear_ray(frame);
  const DoubtfulRay doubtful(*s.world, from, ray, frame, exact != nullptr);
  Query query(s, tree, ray, doubtful, exact);
  return s.has_masks ? query.run<true>(among) : query.run<false>(among);
}

}  // namespace

Verdict verdict(const Structures& structures, const SurfacePoint& from, const Ray& ray, Candidates among) {
  return ask(structures, from, ray, among, nullptr);
}

Verdict certified_verdict(const Structures& structures, const SurfacePoint& from, const Ray& ray,
                          const Light& light, Candidates among) {
  const ExactShadow exact(*structures.world, from, light);
  return ask(structures, from, ray, among, &exact);
}

}  // namespace gnomon::raytrace
