#include "scene/light_shape/light_shape.h"

#include "scene/scene.h"

namespace gnomon {

LightHull PointShape::hull(const Light& light, const LitWorld&) const {
  return {{light.position}, light.position, 0.0};
}

void PointShape::set_up(LightSampler& sampler, const Light&) const {
  sampler.aim = [](const LightSampler& s, const Vec2&) { return s.center; };
}

std::string_view shape_name(const LightExtent& extent) {
  return std::visit([](const auto& shape) { return shape.name; }, extent);
}

std::string_view shape_define(const LightExtent& extent) {
  return std::visit([](const auto& shape) { return shape.shader_define; }, extent);
}

bool is_sun_shape(const LightExtent& extent) {
  return std::visit([](const auto& shape) { return shape.is_sun; }, extent);
}

double shape_size(const LightExtent& extent) {
  return std::visit([](const auto& shape) { return shape.size(); }, extent);
}

bool resize_shape(LightExtent& extent, double size) {
  return std::visit([&](auto& shape) { return shape.resize(size); }, extent);
}

ShapeMeasures shape_measures(LightExtent& extent) {
  return std::visit([](auto& shape) { return shape.measures(); }, extent);
}

void turn_shape(LightExtent& extent, FunctionRef<Vec3(const Vec3&)> turned) {
  for (const ShapeMeasure& measure : shape_measures(extent)) {
    if (measure.kind == ShapeMeasure::Kind::normal) *measure.vector = glm::normalize(turned(*measure.vector));
    if (measure.kind == ShapeMeasure::Kind::side) *measure.vector = turned(*measure.vector);
  }
}

Vec3 shape_half_extent(const LightExtent& extent) {
  return std::visit([](const auto& shape) { return shape.half_extent(); }, extent);
}

LightHull light_hull(const Light& light, const LitWorld& world) {
  LightHull hull = std::visit([&](const auto& shape) { return shape.hull(light, world); }, light.extent);
  hull.radius *= 1.0 + 0x1p-40;
  return hull;
}

LightSampler light_sampler(const Light& light, const Vec3& from) {
  LightSampler sampler{from, light.type == LightType::directional ? -light.direction : light.position};
  std::visit([&](const auto& shape) { shape.set_up(sampler, light); }, light.extent);
  return sampler;
}

ShaderArea shape_shader_area(const LightExtent& extent, const LightFace& face) {
  return std::visit([&](const auto& shape) { return shape.shader_area(face); }, extent);
}

std::vector<Vec3> square_around(const Vec3& center, const Vec3& u, const Vec3& v) {
  constexpr double wider = 1.0 + 0x1p-40;
  const Vec3 a = wider * u, b = wider * v;
  return {center - a - b, center + a - b, center + a + b, center - a + b};
}

std::vector<Vec3> square_around_disc(const Vec3& center, const Vec3& normal, double radius) {
  Vec3 u, v;
  orthonormal_basis(normal, u, v);
  return square_around(center, radius * u, radius * v);
}

// A point of the disc lifted onto the cap of directions: 1 - cos grows as the disc's area does. No difference of nearly
// equal numbers enters, so a cone of any width keeps its shape.
ConeDirection cone_direction(const LightSampler& s, const Vec2& square) {
  const Vec2 p = concentric_disc(square);
  const double versine = s.cap * glm::dot(p, p);
  const double spread = std::sqrt(s.cap * (2.0 - versine));
  return {(1.0 - versine) * s.axis + spread * (p.x * s.u + p.y * s.v), versine, spread, glm::length(p)};
}

}  // namespace gnomon
