// Rough mirrors and rough glass are GGX microfacets (Walter et al. 2007, "Microfacet Models for Refraction
// through Rough Surfaces"). Their visible normals are sampled (Heitz 2018, "Sampling the GGX Distribution of
// Visible Normals", JCGT 7(4), listing 1). alpha is roughness squared. With visible normals a sample's weight
// is the share of its outgoing direction that other facets do not hide, G1 (Smith; Heitz 2014, eq. 43): never
// above 1, and 1 as alpha goes to 0. Light that facets would hand on to each other is lost, as in every
// single-scattering model.
#pragma once

#include "scene/math.h"

namespace gnomon::raytrace {

class Microfacets {
 public:
  /// normal: unit shading normal; towards: unit, where the path came from, dot > 0.
  Microfacets(const Vec3& normal, const Vec3& towards, double roughness)
      : normal_(normal), alpha_(roughness * roughness) {
    orthonormal_basis(normal, tangent_, bitangent_);
    const Vec3 local(glm::dot(towards, tangent_), glm::dot(towards, bitangent_), glm::dot(towards, normal));
    stretched_ = glm::normalize(Vec3(alpha_ * local.x, alpha_ * local.y, local.z));
    const double across = std::hypot(stretched_.x, stretched_.y);
    u_ = across > 0.0 ? Vec3(-stretched_.y, stretched_.x, 0.0) / across : Vec3(1.0, 0.0, 0.0);
    v_ = glm::cross(stretched_, u_);
  }

  /// A facet's unit normal, chosen by a point of the unit square, area to visible area.
  Vec3 normal(const Vec2& square) const {
    const double radius = std::sqrt(square.x), angle = 2.0 * pi * square.y;
    const double x = radius * std::cos(angle), height = std::sqrt(std::max(0.0, (1.0 - x) * (1.0 + x)));
    const double half = 0.5 * (1.0 + stretched_.z);
    const double y = (1.0 - half) * height + half * radius * std::sin(angle);
    const double z = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
    const Vec3 n = x * u_ + y * v_ + z * stretched_;
    const Vec3 slope(alpha_ * n.x, alpha_ * n.y, std::max(0.0, n.z));
    const double length = glm::length(slope);
    if (!(length > 0.0)) return normal_;
    return (slope.x * tangent_ + slope.y * bitangent_ + slope.z * normal_) / length;
  }

  /// Share of a direction on either side that is not hidden.
  double visible_share(const Vec3& direction) const {
    const double cosine = glm::dot(direction, normal_);
    const double slope = alpha_ * alpha_ * std::max(0.0, 1.0 / (cosine * cosine) - 1.0);
    return 2.0 / (1.0 + std::sqrt(1.0 + slope));
  }

 private:
  Vec3 normal_, tangent_{0.0}, bitangent_{0.0};
  double alpha_;
  Vec3 stretched_{0.0}, u_{0.0}, v_{0.0};  // of the hemisphere configuration, local
};

}  // namespace gnomon::raytrace
