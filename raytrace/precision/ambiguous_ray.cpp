#include "raytrace/precision/ambiguous_ray.h"

#include "raytrace/precision/visibility.h"

namespace gnomon::raytrace {
namespace {

// Roundings in a sheared coordinate: the direction's (6), the difference, the product, the sum.
constexpr int coordinate_operations = 12;

double axis(const Vec3& v, std::size_t a) {
  return v[static_cast<int>(a)];
}

/// Tells of a point that it is no higher than the tangent plane, but for rounding; a ray that leaves the tangent plane is
/// clearly above that rounding at this distance.
struct BelowHorizon {
  bool below, left;
};

}  // namespace

AmbiguousRay::AmbiguousRay(const World& world, const SurfacePoint& from, const Ray& ray,
                           const RayFrame& frame, bool decided)
    : world_(world),
      from_(from),
      ray_(frame),
      decided_(decided),
      is_known_(is_known_exactly(world, from.primitive)),
      surely_out_(frame.t.max) {
  error_ = origin_error(from, ray);
  error_x_ = axis(error_, frame.kx) + std::abs(frame.shear_x) * axis(error_, frame.kz);
  error_y_ = axis(error_, frame.ky) + std::abs(frame.shear_y) * axis(error_, frame.kz);
  const Aabb& bounds = world.finite_bounds;
  const double reach =
      bounds.empty()
          ? 0.0
          : max_component(glm::max(glm::abs(bounds.min - ray.origin), glm::abs(bounds.max - ray.origin)));
  if (decided) surely_out_ += beyond_end(error_, ray) * frame.kernel_t_from_t;
  coarse_error_ = std::max(error_x_, error_y_) + 2.0 * error_gamma(coordinate_operations) * reach;
}

Intersects AmbiguousRay::in_interval(const Interval3& t) const {
  if (!(t.hi >= ray_.t.min && t.lo < surely_out_)) return Intersects::no;
  return t.lo > ray_.t.min && t.hi < ray_.t.max ? Intersects::surely : Intersects::perhaps;
}

AmbiguousRay::Interval3 AmbiguousRay::depth_range(const ShearedTriangle& s, double det_error,
                                                  double depth_error) const {
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

Intersects AmbiguousRay::intersects_triangle(const ShearedTriangle& s, const LeafPrimitive& triangle,
                                             int& edge) const {
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
  const std::array<double, 3> error{bound(0, 1), bound(1, 2), bound(2, 0)};
  int above = 0, below = 0, open = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    if (value[k] > error[k])
      ++above;
    else if (value[k] < -error[k])
      ++below;
    else
      open = static_cast<int>(k);
  }
  if (above > 0 && below > 0) return Intersects::no;
  const double det_error = error[0] + error[1] + error[2] + error_gamma(3) * std::abs(s.u + s.v + s.w);
  const Intersects range = in_interval(depth_range(s, det_error, axis(error_, ray_.kz) + g * reach_z));
  if (range == Intersects::no) return Intersects::no;
  if (above == 3 || below == 3) return range;
  if (range == Intersects::surely && above + below == 2) edge = open;
  return Intersects::perhaps;
}

bool AmbiguousRay::passes_box(const LeafPrimitive& triangle) const {
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

Intersects AmbiguousRay::intersects_plane(std::uint32_t id) const {
  const auto& plane = std::get<Plane>(world_.shape(id).geometry);
  double height = 0.0, slope = 0.0, height_error = 0.0, slope_error = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double n = axis(plane.normal, a), p = axis(plane.point, a);
    height += n * (p - ray_.origin[a]);
    slope += n * ray_.direction[a];
    height_error += std::abs(n) * (error_gamma(5) * std::abs(p - ray_.origin[a]) + axis(error_, a));
    slope_error += std::abs(n * ray_.direction[a]) * error_gamma(8);
  }
  if (std::abs(height) <= height_error) {
    if (takes_receiver()) return Intersects::perhaps;
    // The point lies on this plane: it is hit at the origin or nowhere, and then it is the same surface.
    return std::abs(slope) <= slope_error || is_same_surface(plane) ? Intersects::no : Intersects::perhaps;
  }
  if (std::abs(slope) <= slope_error) {
    if (decided_) return Intersects::perhaps;
    // Nearly along the plane: hit very far away, if at all.
    const double nearest = (std::abs(height) - height_error) / (std::abs(slope) + slope_error);
    return nearest < ray_.t.max && std::isfinite(ray_.t.max) ? Intersects::perhaps : Intersects::no;
  }
  const double t = height / slope;
  const double spread = (height_error + std::abs(t) * slope_error) / (std::abs(slope) - slope_error) +
                        error_gamma(3) * std::abs(t);
  return in_interval({t - spread, t + spread});
}

bool clearly_leaves(const Plane& plane, const Ray& ray, const Vec3& error) {
  constexpr double clearly = 8.0;
  const Vec3 n = glm::abs(plane.normal), offset = plane.point - ray.origin;
  const double height = glm::dot(plane.normal, offset), slope = glm::dot(plane.normal, ray.direction);
  const double height_error = glm::dot(n, error_gamma(5) * glm::abs(offset) + error);
  const double slope_error = error_gamma(8) * glm::dot(n, glm::abs(ray.direction));
  return (height < 0.0) != (slope < 0.0) && std::abs(height) > clearly * height_error &&
         std::abs(slope) > clearly * slope_error;
}

bool AmbiguousRay::is_same_surface(const Plane& plane) const {
  return glm::length(glm::cross(plane.normal, from_.normal)) <= error_gamma(16);
}

Intersects AmbiguousRay::intersects_shape(std::uint32_t id) const {
  const ShapeGeometry& geometry = world_.shape(id).geometry;
  if (!is_solid(geometry)) return intersects_sphere(id);
  return intersects_solid(ray_, surely_out_, error_, geometry,
                          id == from_.primitive ? &from_.normal : nullptr);
}

Intersects AmbiguousRay::intersects_sphere(std::uint32_t id) const {
  const auto& sphere = std::get<Sphere>(world_.shape(id).geometry);
  const Vec3 d(ray_.direction[0], ray_.direction[1], ray_.direction[2]);
  const Vec3 offset = Vec3(ray_.origin[0], ray_.origin[1], ray_.origin[2]) - sphere.center;
  const double length_squared = glm::dot(d, d), length = std::sqrt(length_squared);
  const double middle = -glm::dot(offset, d) / length_squared;
  const double distance = glm::length(offset + middle * d);
  const double error = error_gamma(16) * glm::length(offset) + glm::length(error_);
  if (distance - error > sphere.radius) return Intersects::no;
  const double t_error = error / length;
  const auto half_chord = [&](double off_axis) {
    return std::sqrt(std::max(0.0, (sphere.radius - off_axis) * (sphere.radius + off_axis))) / length;
  };
  const double half_max = half_chord(std::max(0.0, distance - error)) * (1.0 + error_gamma(4));
  const double half_min = half_chord(std::min(sphere.radius, distance + error)) * (1.0 - error_gamma(4));
  const Interval3 near{middle - half_max - t_error, middle - half_min + t_error};
  const Interval3 far{middle + half_min - t_error, middle + half_max + t_error};
  const Start start = start_on(id, offset, near, far);
  if (start == Start::far) return Intersects::no;
  if (start == Start::near) return in_interval(far);
  const Intersects a = in_interval(near), b = in_interval(far);
  if (distance + error < sphere.radius && (a == Intersects::surely || b == Intersects::surely))
    return Intersects::surely;
  return a == Intersects::no && b == Intersects::no ? Intersects::no : Intersects::perhaps;
}

AmbiguousRay::Start AmbiguousRay::start_on(std::uint32_t id, const Vec3& offset, const Interval3& near,
                                           const Interval3& far) const {
  if (id == from_.primitive) return glm::dot(from_.normal, offset) < 0.0 ? Start::near : Start::far;
  // On another one, within rounding: of a sphere or a solid alone, for no sphere is the surface that a flat one is.
  if (is_known_ || !(near.hi < far.lo)) return Start::elsewhere;
  if (near.lo <= 0.0 && near.hi >= 0.0) return Start::near;
  return far.lo <= 0.0 && far.hi >= 0.0 ? Start::far : Start::elsewhere;
}

double AmbiguousRay::rise() const {
  const Vec3 n = from_.normal, d(ray_.direction[0], ray_.direction[1], ray_.direction[2]);
  // Of a unit normal and of a direction that was made one.
  return glm::dot(n, d) - error_gamma(32) * glm::length(d);
}

bool AmbiguousRay::clearly_rises() const {
  if (!std::isfinite(ray_.t.max)) return rise() > 0.0;
  return ray_.t.max * rise() > 2.0 * glm::dot(glm::abs(from_.normal), error_);
}

bool AmbiguousRay::below_horizon(std::uint32_t id) const {
  // A light in the tangent plane: which side of it the ray takes is a matter of rounding.
  if (!clearly_rises()) return false;
  const Vec3 n = from_.normal, along(ray_.direction[0], ray_.direction[1], ray_.direction[2]);
  const double slack = glm::dot(glm::abs(n), from_.position_error), slope = rise() / glm::length(along);
  // `reach`: of a sphere or a solid, to all sides of p.
  const auto is_below = [&](const Vec3& p, double height, double reach) {
    const Vec3 d = p - from_.position;
    const double bound = error_gamma(8) * (glm::dot(glm::abs(n), glm::abs(d)) + height) + slack;
    return BelowHorizon{glm::dot(n, d) + height <= bound, slope * (glm::length(d) + reach) > 4.0 * bound};
  };
  if (world_.is_triangle(id)) {
    const auto [a, b, c] = world_.corners(id);
    const BelowHorizon p = is_below(a, 0.0, 0.0), q = is_below(b, 0.0, 0.0), r = is_below(c, 0.0, 0.0);
    return p.below && q.below && r.below && (p.left || q.left || r.left);
  }
  const ShapeGeometry& geometry = world_.shape(id).geometry;
  const auto holds = [](const BelowHorizon& p) { return p.below && p.left; };
  if (is_solid(geometry)) return holds(is_below(solid_center(geometry), reach_along(geometry, n), 0.0));
  const auto* sphere = std::get_if<Sphere>(&geometry);
  return sphere != nullptr && holds(is_below(sphere->center, sphere->radius, sphere->radius));
}

bool AmbiguousRay::beyond_light(std::uint32_t id) const {
  const Vec3 d(ray_.direction[0], ray_.direction[1], ray_.direction[2]);
  const double end = ray_.t.max * glm::dot(d, d);
  const auto is_beyond = [&](const Vec3& p, double radius) {
    const Vec3 offset = p - Vec3(ray_.origin[0], ray_.origin[1], ray_.origin[2]);
    const double reach = radius * glm::length(d);  // of a solid: of its box along d
    const double bound = error_gamma(8) * (glm::dot(glm::abs(d), glm::abs(offset)) + reach + std::abs(end));
    return glm::dot(d, offset) - reach >= end - bound;
  };
  if (world_.is_triangle(id)) {
    const auto [a, b, c] = world_.corners(id);
    return is_beyond(a, 0.0) && is_beyond(b, 0.0) && is_beyond(c, 0.0);
  }
  const ShapeGeometry& geometry = world_.shape(id).geometry;
  if (is_solid(geometry)) return is_beyond(solid_center(geometry), reach_along(geometry, glm::normalize(d)));
  const auto* sphere = std::get_if<Sphere>(&geometry);
  return sphere != nullptr && is_beyond(sphere->center, sphere->radius);
}

}  // namespace gnomon::raytrace
