#include "raytrace/precision/visibility.h"

#include "scene/shapes/solid.h"

namespace gnomon::raytrace {

bool ExactShadow::decides(std::uint32_t id) const {
  return world_.is_triangle(id) || !is_solid(world_.shape(id).geometry);
}

bool ExactShadow::blocks(std::uint32_t id) const {
  if (world_.is_triangle(id)) return triangle_blocks(id);
  const auto& geometry = world_.shape(id).geometry;
  if (const auto* plane = std::get_if<Plane>(&geometry)) return plane_blocks(*plane);
  const auto& sphere = std::get<Sphere>(geometry);
  return is_own(sphere) ? source_sphere_blocks(sphere) : sphere_blocks(sphere);
}

// The receiver's stored position lies on it but for rounding.
bool ExactShadow::is_own(const Sphere& sphere) const {
  if (world_.is_triangle(from_.primitive)) return false;
  const auto* own = std::get_if<Sphere>(&world_.shape(from_.primitive).geometry);
  return own != nullptr && own->center == sphere.center && own->radius == sphere.radius;
}

const ExactShadow::Receiver& ExactShadow::receiver() const {
  if (receiver_) return *receiver_;
  receiver_ = Receiver{Dyadic3(from_.position), Dyadic(1.0)};
  if (world_.is_triangle(from_.primitive)) {
    const auto [a, b, c] = world_.corners(from_.primitive);
    const Dyadic b1(from_.barycentric.x), b2(from_.barycentric.y), b0 = Dyadic(1.0) - b1 - b2;
    receiver_->point = b0 * Dyadic3(a) + b1 * Dyadic3(b) + b2 * Dyadic3(c);
  } else if (const auto* plane = std::get_if<Plane>(&world_.shape(from_.primitive).geometry)) {
    const Dyadic3 n(plane->normal);
    const Dyadic height = dot(n, receiver_->point - Dyadic3(plane->point));
    receiver_->weight = dot(n, n);
    receiver_->point = receiver_->weight * receiver_->point - height * n;
  }
  return *receiver_;
}

Dyadic3 ExactShadow::to_light() const {
  if (is_directional()) return Dyadic3(-light_.direction);
  return receiver().weight * Dyadic3(light_.position) - receiver().point;
}

bool ExactShadow::crosses(const Dyadic3& normal, const Dyadic3& point) const {
  const int here = dot(normal, receiver().point - receiver().weight * point).sign();
  const int there = is_directional() ? -dot(normal, Dyadic3(light_.direction)).sign()
                                     : dot(normal, Dyadic3(light_.position) - point).sign();
  return here * there < 0;
}

bool ExactShadow::plane_blocks(const Plane& plane) const {
  return crosses(Dyadic3(plane.normal), Dyadic3(plane.point));
}

bool ExactShadow::triangle_blocks(std::uint32_t id) const {
  const auto corners = world_.corners(id);
  const std::array<Dyadic3, 3> c{Dyadic3(corners[0]), Dyadic3(corners[1]), Dyadic3(corners[2])};
  if (!crosses(cross(c[1] - c[0], c[2] - c[0]), c[0])) return false;
  const Dyadic3 direction = to_light();
  std::array<Dyadic3, 3> seen;
  for (std::size_t i = 0; i < 3; ++i) seen[i] = receiver().weight * c[i] - receiver().point;
  int above = 0, below = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = dot(direction, cross(seen[i], seen[(i + 1) % 3])).sign();
    above += side > 0 ? 1 : 0, below += side < 0 ? 1 : 0;
  }
  return above == 0 || below == 0;
}

// f(s) = |receiver + s d - center|^2 - r^2 = A s^2 + 2 B s + C in 0 < s < 1 (or s > 0).
bool ExactShadow::sphere_blocks(const Sphere& sphere) const {
  const Dyadic3 d = to_light(), o = receiver().point - receiver().weight * Dyadic3(sphere.center);
  const Dyadic reach = receiver().weight * Dyadic(sphere.radius);
  const Dyadic a = dot(d, d), b = dot(o, d), c = dot(o, o) - reach * reach;
  const int at_receiver = c.sign();
  const bool line_intersects_sphere = (b * b - a * c).sign() >= 0;
  if (is_directional()) return at_receiver < 0 || (b.sign() < 0 && line_intersects_sphere);
  const int at_light = (a + b + b + c).sign();
  if (at_receiver * at_light < 0) return true;
  if (at_receiver < 0 || at_light < 0) {  // one end within; the other within too, or on the sphere
    return false;
  }
  if (at_receiver == 0 && at_light == 0) return false;
  if (at_receiver == 0) return b.sign() < 0 && (a + b + b).sign() > 0;  // the other root: -2 B / A
  if (at_light == 0) return (a - c).sign() > 0;                         // the other root: C / A
  return line_intersects_sphere && b.sign() < 0 && (a + b).sign() > 0;
}

// Seen from outside, the sphere is below its own tangent plane; from within, it is hit unless the light is
// within too.
bool ExactShadow::source_sphere_blocks(const Sphere& sphere) const {
  if (glm::dot(from_.normal, from_.position - sphere.center) > 0.0) return false;
  if (is_directional()) return true;
  const Dyadic3 o = Dyadic3(light_.position) - Dyadic3(sphere.center);
  return (dot(o, o) - Dyadic(sphere.radius) * Dyadic(sphere.radius)).sign() > 0;
}

}  // namespace gnomon::raytrace
