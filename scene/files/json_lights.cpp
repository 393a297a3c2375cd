// Lights of a JSON scene.
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "scene/files/json_parts.h"
#include "scene/files/read_file.h"
#include "scene/light_type_name.h"

namespace gnomon {
namespace {

// The sun stands at this elevation and azimuth; its light travels the other way.
Vec3 sun_direction(double elevation, double azimuth) {
  return -Vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
               std::cos(elevation) * std::cos(azimuth));
}

Vec3 directional_direction(const JsonObject& object) {
  for (const std::string_view key : {"position", "target", "inner_angle_degrees", "outer_angle_degrees"})
    object.forbid(key, "does not apply to a directional light");
  const std::string_view given = object.exactly_one({"direction", "elevation_degrees"});
  if (given == "direction") {
    object.forbid("azimuth_degrees", "cannot stand beside direction");
    return object.find("direction")->as_direction();
  }
  if (given.empty()) return {0.0, -1.0, 0.0};
  const double elevation = object.number("elevation_degrees", 0.0, {-90.0, 90.0});
  const auto azimuth = object.require("azimuth_degrees");
  return sun_direction(elevation * pi / 180.0,
                       (azimuth ? azimuth->as_number({-360.0, 360.0}) : 0.0) * pi / 180.0);
}

void read_position(const JsonObject& object, Light& light) {
  for (const std::string_view key : {"elevation_degrees", "azimuth_degrees"})
    object.forbid(key, "applies to a directional light only");
  if (const auto position = object.require("position")) light.position = position->as_vec3();
}

void read_spot(const JsonObject& object, Light& light) {
  read_position(object, light);
  const std::string_view given = object.exactly_one({"direction", "target"});
  if (given == "direction") light.direction = object.find("direction")->as_direction();
  if (given == "target") {
    const JsonNode target = *object.find("target");
    const Vec3 way = target.as_vec3() - light.position;
    if (way == Vec3(0.0))
      target.error("is the light's position (allowed: another point)");
    else
      light.direction = glm::normalize(way);
  }
  const double inner = object.number("inner_angle_degrees", 0.0, {0.0, 90.0, false, true});
  const double outer = object.number("outer_angle_degrees", 45.0, {0.0, 90.0, true, true});
  if (inner >= outer) {
    const auto at = object.find("inner_angle_degrees") ? object.find("inner_angle_degrees")
                                                       : object.find("outer_angle_degrees");
    at->error(fmt::format(
        "the inner angle must be below the outer (got {:g} and {:g}, allowed inner < outer)", inner, outer));
  }
  light.inner_angle = inner * pi / 180.0;
  light.outer_angle = outer * pi / 180.0;
}

constexpr NumberRange extent_range{0.0, max_coordinate};

SphereLight read_sphere_light(const JsonNode& node) {
  const JsonObject object(node, {"radius"});
  const auto radius = object.require("radius");
  return {radius ? radius->as_number(extent_range) : 0.0};
}

// A spot's disc or rectangle lies across its direction, a point's faces down, unless a normal is given.
Vec3 read_normal(const JsonObject& object, const Light& light) {
  if (const auto normal = object.find("normal")) return normal->as_direction();
  return light.type == LightType::spot ? light.direction : Vec3(0.0, -1.0, 0.0);
}

DiscLight read_disc(const JsonNode& node, const Light& light) {
  const JsonObject object(node, {"radius", "normal"});
  const auto radius = object.require("radius");
  return {radius ? radius->as_number(extent_range) : 0.0, read_normal(object, light)};
}

// The height runs along the part of `up` that lies in the rectangle's plane.
RectangleLight read_rectangle(const JsonNode& node, const Light& light) {
  const JsonObject object(node, {"width", "height", "normal", "up"});
  const auto width = object.require("width"), height = object.require("height");
  const Vec3 normal = read_normal(object, light);
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
  if (!width || !height) return {};
  return {0.5 * width->as_number(extent_range) * right, 0.5 * height->as_number(extent_range) * up};
}

LightExtent read_extent(const JsonObject& object, const Light& light) {
  const std::vector<std::string_view> keys{"sphere", "disc", "rectangle"};
  if (light.type == LightType::directional) {
    for (const std::string_view key : keys) object.forbid(key, "does not apply to a directional light");
    const auto angle = object.find("angular_diameter_degrees");
    if (!angle) return {};
    return SunDisc{angle->as_number({0.0, 90.0}) * pi / 180.0};
  }
  object.forbid("angular_diameter_degrees", "applies to a directional light only");
  if (std::none_of(keys.begin(), keys.end(), [&](std::string_view key) { return object.has(key); }))
    return {};
  const std::string_view given = object.exactly_one(keys);
  if (given == "sphere") return read_sphere_light(*object.find(given));
  if (given == "disc") return read_disc(*object.find(given), light);
  if (given == "rectangle") return read_rectangle(*object.find(given), light);
  return {};
}

void read_size(const JsonObject& object, Light& light) {
  light.extent = read_extent(object, light);
  if (std::holds_alternative<std::monostate>(light.extent))
    object.forbid("shadow_samples",
                  "applies to a light with a size only (angular_diameter_degrees, sphere, disc, rectangle)");
  light.shadow_samples = static_cast<int>(
      object.number("shadow_samples", light.shadow_samples, {1.0, max_shadow_samples, false, false, true}));
}

Light read_light(const JsonNode& node) {
  const JsonObject object(
      node, {"name", "type", "position", "direction", "target", "elevation_degrees", "azimuth_degrees",
             "intensity", "inner_angle_degrees", "outer_angle_degrees", "angular_diameter_degrees", "sphere",
             "disc", "rectangle", "shadow_samples"});
  Light light;
  light.name = object.string("name");
  light.intensity = object.color("intensity", Vec3f(1.0f));
  const auto type = object.require("type");
  if (!type) return light;
  light.type = static_cast<LightType>(type->as_choice({light_type_names.begin(), light_type_names.end()}));
  if (node.errors().first) return light;
  switch (light.type) {
    case LightType::directional:
      light.direction = directional_direction(object);
      break;
    case LightType::point:
      for (const std::string_view key : {"direction", "target", "inner_angle_degrees", "outer_angle_degrees"})
        object.forbid(key, "does not apply to a point light");
      read_position(object, light);
      break;
    case LightType::spot:
      read_spot(object, light);
      break;
  }
  if (!node.errors().first) read_size(object, light);
  return light;
}

}  // namespace

void read_lights(SceneReader& reader, const JsonNode& list) {
  const auto nodes = list.as_array();
  if (list.is(JsonValue::Type::array) && nodes.empty())
    list.error("is empty (allowed: at least one light, or no list for a default sun)");
  std::set<std::string> names;
  for (const Light& light : reader.scene.lights) names.insert(light.name);
  for (const JsonNode& node : nodes) {
    Light light = read_light(node);
    if (reader.failed()) return;
    if (light.name.empty())
      light.name = fmt::format("{}-{}", light_type_name(light.type), reader.scene.lights.size() + 1);
    if (!names.insert(light.name).second)
      return node.error(fmt::format("another light has this name (got \"{}\")", printable(light.name)));
    reader.scene.lights.push_back(std::move(light));
  }
}

}  // namespace gnomon
