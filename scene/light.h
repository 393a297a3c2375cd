// What a light is to a point: its direction, distance and strength, and the decision that a surface cannot be
// lit at all. Both renderers take these from here (shaders/light.glsl is the GLSL twin).
#pragma once

#include <array>
#include <string_view>

#include "scene/scene.h"

namespace gnomon {

/// What kinds of lights are called, in scene files and in results, by LightType.
inline constexpr std::array<std::string_view, 3> light_type_names{"directional", "point", "spot"};
inline std::string_view light_type_name(LightType type) {
  return light_type_names[static_cast<std::size_t>(type)];
}

struct LightAtPoint {
  Vec3 to_light;     ///< unit
  double distance;   ///< infinity for a directional light
  Vec3f irradiance;  ///< on a surface facing the light: intensity / distance^2 * spot falloff
};

LightAtPoint light_at(const Light& light, const Vec3& position);

/// Cosine of a spot's inner angle less that of its outer one, kept from 0.
double spot_ramp(const Light& light);

/// Smooth spot falloff in [0, 1]: 1 inside inner_angle, 0 from outer_angle on, the KHR_lights_punctual
/// formula.
double spot_falloff(const Light& light, const Vec3& to_light);

/// Returns the size of a light's shape, as shape_size() has it.
inline double light_size(const Light& light) {
  return shape_size(light.extent);
}
/// Whether the light casts soft shadows.
inline bool has_size(const Light& light) {
  return light_size(light) > 0.0;
}

/// The geometric normal turned to the side that `direction` (from the eye to the surface) arrives from.
inline Vec3 face_forward(const Vec3& normal, const Vec3& direction) {
  return glm::dot(normal, direction) > 0.0 ? -normal : normal;
}

/// The facing-away decision: a surface whose geometric normal n (on the viewer's side) has n·l <= 0, or that
/// lies outside the spot's cone, is unlit whatever shadows say. NaN counts as facing away.
bool light_cannot_reach(const Light& light, const Vec3& position, const Vec3& normal);

}  // namespace gnomon
