// A rectangle, sampled by area (Shirley, Wang and Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations",
// section 4).
#include "scene/files/json/json_reader.h"

namespace gnomon {

double RectangleLight::size() const {
  return glm::length(half_width + half_height);
}

bool RectangleLight::resize(double size) {
  const double before = this->size();
  if (!(before > 0.0)) return false;
  half_width *= size / before, half_height *= size / before;
  return true;
}

ShapeMeasures RectangleLight::measures() {
  return {{"half_width", ShapeMeasure::Kind::side, nullptr, &half_width},
          {"half_height", ShapeMeasure::Kind::side, nullptr, &half_height}};
}

Vec3 RectangleLight::half_extent() const {
  return glm::abs(half_width) + glm::abs(half_height);
}

LightHull RectangleLight::hull(const Light& light, const LitWorld&) const {
  return {square_around(light.position, half_width, half_height), light.position, size()};
}

void RectangleLight::set_up(LightSampler& sampler, const Light&) const {
  sampler.u = half_width, sampler.v = half_height;
  sampler.aim = [](const LightSampler& s, const Vec2& square) {
    const Vec2 p = 2.0 * square - 1.0;
    return s.center + p.x * s.u + p.y * s.v;
  };
}

ShaderArea RectangleLight::shader_area(const LightFace&) const {
  return {half_width, half_height};
}

// The height runs along the part of `up` that lies in the rectangle's plane.
bool RectangleLight::read_form(const JsonObject& object, const Vec3& normal) {
  if (object.has("half_width") || object.has("half_height")) return false;
  const auto width = object.require("width"), height = object.require("height");
  Vec3 right, up;
  orthonormal_basis(normal, right, up);
  if (const auto given = object.find("up")) {
    const Vec3 across = glm::cross(given->as_direction(), normal);
    constexpr double narrowest = 1e-6;  // radians between up and the normal: below, it is mostly rounding
    if (!(glm::length(across) > narrowest))
      given->error("is parallel to the rectangle's normal (allowed: across it)");
    else
      right = glm::normalize(across), up = glm::cross(normal, right);
  }
  if (!width || !height) return true;
  constexpr NumberRange side_range{0.0, max_coordinate};
  half_width = 0.5 * width->as_number(side_range) * right;
  half_height = 0.5 * height->as_number(side_range) * up;
  return true;
}

}  // namespace gnomon
