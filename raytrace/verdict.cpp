#include "raytrace/verdict.h"

#include "raytrace/precision/exact_shadow.h"
#include "raytrace/solid_verdict.h"
#include "raytrace/wide/single.h"

namespace gnomon::raytrace {
namespace {

/// A triangle that the ray may or may not meet. When the doubt is about one edge alone, the neighbour across
/// it may resolve it.
struct Doubt {
  std::uint32_t triangle = no_id;
  int edge = -1;          ///< from corner `edge` to the next; -1: more than one, or the distance is in doubt
  bool positive = false;  ///< the projected winding, known when edge >= 0
};

struct Interval3 {  // of a ray parameter
  double lo, hi;
};

/// How far the ray's true origin may lie from its own.
Vec3 origin_error(const SurfacePoint& from, const Ray& ray) {
  return from.position_error + glm::abs(ray.origin - from.position);
}
/// shadow_ray ends before the light by less than this.
double beyond_end(const Vec3& error, const Ray& ray) {
  return 2.0 * (glm::dot(error, Vec3(1.0)) + error_gamma(8) * ray.t.max);
}

class Query {
 public:
  /// exact: none, or what decides every doubt.
  Query(const Structures& s, const WideTree* tree, const SurfacePoint& from, const Ray& ray,
        const RayFrame& frame, const ExactShadow* exact = nullptr)
      : s_(s), tree_(tree), from_(from), given_(ray), ray_(frame), exact_(exact), surely_out_(frame.t.max) {
    const Vec3 error = origin_error(from, ray);
    error_ = error;
    error_x_ = axis(error, frame.kx) + std::abs(frame.shear_x) * axis(error, frame.kz);
    error_y_ = axis(error, frame.ky) + std::abs(frame.shear_y) * axis(error, frame.kz);
    const Aabb& bounds = s.world->finite_bounds;
    const double reach =
        bounds.empty()
            ? 0.0
            : max_component(glm::max(glm::abs(bounds.min - ray.origin), glm::abs(bounds.max - ray.origin)));
    if (exact != nullptr) surely_out_ += beyond_end(error, ray) * frame.kernel_t_from_t;
    coarse_error_ = std::max(error_x_, error_y_) + 2.0 * error_gamma(coordinate_operations) * reach;
  }

  template <bool masks>
  Verdict run(Candidates among) {
    for (const std::uint32_t plane : s_.planes)
      if (plane != from_.primitive && count<masks>(plane, meet_plane(plane), -1, false))
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
  // Roundings in a sheared coordinate: the direction's (6), the difference, the product, the sum.
  static constexpr int coordinate_operations = 12;
  static constexpr std::size_t remembered_doubts = 8;

  static double axis(const Vec3& v, std::size_t a) { return v[static_cast<int>(a)]; }

  /// The floats of the wide tree leave out no triangle that meet_triangle() would not (raytrace/wide/ray.h).
  template <class Visit>
  bool walk_all(const Visit& visit_leaf) const {
    if (tree_ != nullptr) {
      const auto visit_one = [&](std::uint32_t leaf, WideRay&) { return visit_leaf(leaf); };
      Ray ray = given_;
      ray.t.max = surely_out_ / ray_.kernel_t_from_t;
      const WideWalk walked =
          visit_candidates(*tree_, ray, {.origin_error = max_component(error_)}, visitor_of(visit_one));
      if (walked != WideWalk::refused) return walked == WideWalk::ended;
    }
    BoxRay boxes(ray_, s_.bvh.center, error_);
    boxes.t_max = float_above(surely_out_);
    NoStats stats;
    return walk(s_, boxes, stats, visit_leaf);
  }

  // True ends the walk: a sure hit.
  template <bool masks>
  bool visit(std::uint32_t index) {
    const std::uint32_t id = s_.bvh.ids[index];
    if (s_.has_shapes && !s_.world->is_triangle(id)) return count<masks>(id, meet_shape(id), -1, false);
    LeafPrimitive room;
    const LeafPrimitive& triangle = leaf_at(s_, index, room);
    const ShearedTriangle t = shear(ray_, triangle);
    double size = 0.0;
    for (std::size_t i = 0; i < 3; ++i) size += std::abs(t.x[i]) + std::abs(t.y[i]);
    const double bound = 2.0 * coarse_error_ * (size + coarse_error_);
    const double low = std::min({t.u, t.v, t.w}), high = std::max({t.u, t.v, t.w});
    if (low < -bound && high > bound) return false;
    if (id == from_.primitive) return false;
    int edge = -1;
    const Meets meets = meet_triangle(t, triangle, edge);
    if (meets == Meets::no || (meets == Meets::perhaps && !passes_box(triangle))) return false;
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
    if (meets == Meets::perhaps && (below_horizon(id) || beyond_light(id))) return false;
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
    if (world.scene->materials[world.material_of(id)].alpha_mode != AlphaMode::mask) return true;
    Hit hit;
    hit.primitive = id;
    bool met = false;
    if (world.is_triangle(id)) {
      const auto [a, b, c] = world.corners(id);
      TriangleHit t;
      met = intersect_triangle(ray_, {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}}, t);
      if (met) hit.t = t.t, hit.barycentric = Vec2(t.b1, t.b2);
    } else if (const auto* sphere = std::get_if<Sphere>(&world.shape(id).geometry)) {
      met = intersect_sphere(ray_, {{sphere->center.x, sphere->center.y, sphere->center.z, sphere->radius}},
                             hit.t);
    } else if (is_solid(world.shape(id).geometry)) {
      met = intersect_solid(ray_, world.shape(id).geometry, hit.t);
    } else {
      met = intersect_plane(s_, ray_, id, hit);
    }
    return !met || solid(s_, ray_, hit);
  }

  // The ray leaves on the upper side of the tangent plane at its point, and nothing at or below that plane
  // (but for rounding) can be in its way: coplanar neighbours, coplanar duplicates, the far side of a convex
  // body.
  bool below_horizon(std::uint32_t id) const {
    const Vec3 n = from_.normal;
    const double slack = glm::dot(glm::abs(n), from_.position_error);
    const auto is_below = [&](const Vec3& p, double radius) {
      const Vec3 d = p - from_.position;
      const double bound = error_gamma(8) * (glm::dot(glm::abs(n), glm::abs(d)) + radius) + slack;
      return glm::dot(n, d) + radius <= bound;
    };
    if (s_.world->is_triangle(id)) {
      const auto [a, b, c] = s_.world->corners(id);
      return is_below(a, 0.0) && is_below(b, 0.0) && is_below(c, 0.0);
    }
    const ShapeGeometry& geometry = s_.world->shape(id).geometry;
    if (is_solid(geometry)) return is_below(solid_center(geometry), reach_along(geometry, n));
    const auto* sphere = std::get_if<Sphere>(&geometry);
    return sphere != nullptr && is_below(sphere->center, sphere->radius);
  }

  // Nothing that lies wholly beyond the plane through the light, across the ray, can be in its way. The ray
  // ends before the light by its own error bound; a body that the light touches from behind is told apart so.
  bool beyond_light(std::uint32_t id) const {
    const Vec3 d(ray_.direction[0], ray_.direction[1], ray_.direction[2]);
    const double end = ray_.t.max * glm::dot(d, d);
    const auto is_beyond = [&](const Vec3& p, double radius) {
      const Vec3 offset = p - Vec3(ray_.origin[0], ray_.origin[1], ray_.origin[2]);
      const double reach = radius * glm::length(d);  // of a solid: of its box along d
      const double bound = error_gamma(8) * (glm::dot(glm::abs(d), glm::abs(offset)) + reach + std::abs(end));
      return glm::dot(d, offset) - reach >= end - bound;
    };
    if (s_.world->is_triangle(id)) {
      const auto [a, b, c] = s_.world->corners(id);
      return is_beyond(a, 0.0) && is_beyond(b, 0.0) && is_beyond(c, 0.0);
    }
    const ShapeGeometry& geometry = s_.world->shape(id).geometry;
    if (is_solid(geometry))
      return is_beyond(solid_center(geometry), reach_along(geometry, glm::normalize(d)));
    const auto* sphere = std::get_if<Sphere>(&geometry);
    return sphere != nullptr && is_beyond(sphere->center, sphere->radius);
  }

  // `t` against the ray's interval.
  Meets in_interval(const Interval3& t) const {
    if (!(t.hi >= ray_.t.min && t.lo < surely_out_)) return Meets::no;
    return t.lo > ray_.t.min && t.hi < ray_.t.max ? Meets::surely : Meets::perhaps;
  }

  Meets meet_triangle(const ShearedTriangle& s, const LeafPrimitive& triangle, int& edge) const {
    double reach_x = 0.0, reach_y = 0.0, reach_z = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto reach = [&](std::size_t a) { return std::abs(triangle.v[3 * i + a] - ray_.origin[a]); };
      reach_z = std::max(reach_z, reach(ray_.kz));
      reach_x = std::max(reach_x, reach(ray_.kx));
      reach_y = std::max(reach_y, reach(ray_.ky));
    }
    constexpr double g = error_gamma(coordinate_operations);
    const double ex = error_x_ + g * (reach_x + std::abs(ray_.shear_x) * reach_z);
    const double ey = error_y_ + g * (reach_y + std::abs(ray_.shear_y) * reach_z);
    const auto bound = [&](std::size_t i, std::size_t j) {
      const double dx = std::abs(s.x[i]) + std::abs(s.x[j]), dy = std::abs(s.y[i]) + std::abs(s.y[j]);
      return ey * dx + ex * dy + 2.0 * ex * ey +
             error_gamma(3) * (std::abs(s.x[i] * s.y[j]) + std::abs(s.x[j] * s.y[i]));
    };
    // Edge k runs from corner k to the next: w, u, v are the functions of edges 0, 1, 2.
    const std::array<double, 3> value{s.w, s.u, s.v};
    const std::array<double, 3> doubt{bound(0, 1), bound(1, 2), bound(2, 0)};
    int above = 0, below = 0, open = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      if (value[k] > doubt[k])
        ++above;
      else if (value[k] < -doubt[k])
        ++below;
      else
        open = static_cast<int>(k);
    }
    if (above > 0 && below > 0) return Meets::no;
    const double det_error = doubt[0] + doubt[1] + doubt[2] + error_gamma(3) * std::abs(s.u + s.v + s.w);
    const Meets range = in_interval(depth_range(s, det_error, axis(error_, ray_.kz) + g * reach_z));
    if (range == Meets::no) return Meets::no;
    if (above == 3 || below == 3) return range;
    if (range == Meets::surely && above + below == 2) edge = open;
    return Meets::perhaps;
  }

  // Whether the ray may come to the triangle's own box. Along the whole line of a triangle seen edge-on its
  // edge functions are in doubt; every structure's boxes hold this one, so that what is in doubt does not
  // depend on the structure.
  bool passes_box(const LeafPrimitive& triangle) const {
    double begin = ray_.t.min, end = surely_out_;
    for (std::size_t a = 0; a < 3; ++a) {
      const double p = triangle.v[a] - ray_.origin[a], q = triangle.v[3 + a] - ray_.origin[a],
                   r = triangle.v[6 + a] - ray_.origin[a];
      const double reach = std::max({std::abs(p), std::abs(q), std::abs(r)});
      const double error = axis(error_, a) + 2.0 * error_gamma(coordinate_operations) * reach;
      const double low = std::min({p, q, r}) - error, high = std::max({p, q, r}) + error;
      const double d = ray_.direction[a];
      if (d == 0.0) {
        if (low > 0.0 || high < 0.0) return false;
        continue;
      }
      begin = std::max(begin, (d < 0.0 ? high : low) / d), end = std::min(end, (d < 0.0 ? low : high) / d);
    }
    return begin <= end;
  }

  // Where along the ray the triangle may be met: a mean of the corners' depths with weights known within
  // det_error.
  Interval3 depth_range(const ShearedTriangle& s, double det_error, double depth_error) const {
    double lo = std::min({s.z[0], s.z[1], s.z[2]}), hi = std::max({s.z[0], s.z[1], s.z[2]});
    const double det = s.u + s.v + s.w;
    if (std::abs(det) > 2.0 * det_error) {
      const double z = (s.u * s.z[0] + s.v * s.z[1] + s.w * s.z[2]) / det;
      const double spread =
          2.0 * det_error / (std::abs(det) - det_error) * (hi - lo) + error_gamma(8) * std::abs(z);
      lo = std::max(lo, z - spread), hi = std::min(hi, z + spread);
    }
    const double a = (lo - depth_error) * ray_.shear_z, b = (hi + depth_error) * ray_.shear_z;
    return {std::min(a, b), std::max(a, b)};
  }

  Meets meet_plane(std::uint32_t id) const {
    const auto& plane = std::get<Plane>(s_.world->shape(id).geometry);
    double height = 0.0, slope = 0.0, height_error = 0.0, slope_error = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double n = axis(plane.normal, a), p = axis(plane.point, a);
      height += n * (p - ray_.origin[a]);
      slope += n * ray_.direction[a];
      height_error += std::abs(n) * (error_gamma(5) * std::abs(p - ray_.origin[a]) + axis(error_, a));
      slope_error += std::abs(n * ray_.direction[a]) * error_gamma(8);
    }
    if (std::abs(height) <= height_error) {
      if (exact_ != nullptr) return Meets::perhaps;
      // The point lies on this plane: it is met at the origin or nowhere, and then it is the same surface.
      return std::abs(slope) <= slope_error || is_same_surface(plane) ? Meets::no : Meets::perhaps;
    }
    if (std::abs(slope) <= slope_error) {
      if (exact_ != nullptr) return Meets::perhaps;
      // Nearly along the plane: met very far away, if at all.
      const double nearest = (std::abs(height) - height_error) / (std::abs(slope) + slope_error);
      return nearest < ray_.t.max && std::isfinite(ray_.t.max) ? Meets::perhaps : Meets::no;
    }
    const double t = height / slope;
    const double spread = (height_error + std::abs(t) * slope_error) / (std::abs(slope) - slope_error) +
                          error_gamma(3) * std::abs(t);
    return in_interval({t - spread, t + spread});
  }

  // A plane through the point whose normal is the point's own, but for rounding.
  bool is_same_surface(const Plane& plane) const {
    return glm::length(glm::cross(plane.normal, from_.normal)) <= error_gamma(16);
  }

  Meets meet_shape(std::uint32_t id) const {
    const ShapeGeometry& geometry = s_.world->shape(id).geometry;
    if (!is_solid(geometry)) return meet_sphere(id);
    return meet_solid(ray_, surely_out_, error_, geometry, id == from_.primitive ? &from_.normal : nullptr);
  }

  Meets meet_sphere(std::uint32_t id) const {
    const auto& sphere = std::get<Sphere>(s_.world->shape(id).geometry);
    const Vec3 d(ray_.direction[0], ray_.direction[1], ray_.direction[2]);
    const Vec3 offset = Vec3(ray_.origin[0], ray_.origin[1], ray_.origin[2]) - sphere.center;
    const double length_squared = glm::dot(d, d), length = std::sqrt(length_squared);
    const double middle = -glm::dot(offset, d) / length_squared;
    const double distance = glm::length(offset + middle * d);
    const double doubt = error_gamma(16) * glm::length(offset) + glm::length(error_);
    if (distance - doubt > sphere.radius) return Meets::no;
    const double t_doubt = doubt / length;
    const auto half_chord = [&](double off_axis) {
      return std::sqrt(std::max(0.0, (sphere.radius - off_axis) * (sphere.radius + off_axis))) / length;
    };
    const double half_max = half_chord(std::max(0.0, distance - doubt)) * (1.0 + error_gamma(4));
    const double half_min = half_chord(std::min(sphere.radius, distance + doubt)) * (1.0 - error_gamma(4));
    const Interval3 near{middle - half_max - t_doubt, middle - half_min + t_doubt};
    const Interval3 far{middle + half_min - t_doubt, middle + half_max + t_doubt};
    if (id == from_.primitive) {  // the point is one of the roots; from within, the other one is ahead
      const bool within = glm::dot(from_.normal, offset) < 0.0;
      return within ? in_interval(far) : Meets::no;
    }
    const Meets a = in_interval(near), b = in_interval(far);
    if (distance + doubt < sphere.radius && (a == Meets::surely || b == Meets::surely)) return Meets::surely;
    return a == Meets::no && b == Meets::no ? Meets::no : Meets::perhaps;
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
  const SurfacePoint& from_;
  const Ray& given_;
  const RayFrame& ray_;
  const ExactShadow* exact_;
  double surely_out_;  ///< nothing from here on can be in the way
  Vec3 error_;
  double error_x_, error_y_, coarse_error_;
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
  if (walked == WideWalk::done && found.count == 0 && s.planes.empty()) answer = Verdict::lit;
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
  Query query(s, tree, from, ray, frame, exact);
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
