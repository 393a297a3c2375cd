// Lights of a JSON scene.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scene/files/json/json_parts.h"
#include "scene/files/json/light_json.h"
#include "scene/files/read_file.h"

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

void read_size(const JsonObject& object, Light& light) {
  light.extent = read_shape(object, light, AngleForm::degrees);
  if (std::holds_alternative<PointShape>(light.extent))
    object.forbid("shadow_samples", fmt::format("applies to a light with a size only ({})",
                                                fmt::join(shape_keys(AngleForm::degrees), ", ")));
  light.shadow_samples = static_cast<int>(
      object.number("shadow_samples", light.shadow_samples, {1.0, max_shadow_samples, false, false, true}));
}

Light read_light(const JsonNode& node) {
  std::vector<std::string_view> keys{"name",
                                     "type",
                                     "position",
                                     "direction",
                                     "target",
                                     "elevation_degrees",
                                     "azimuth_degrees",
                                     "intensity",
                                     "inner_angle_degrees",
                                     "outer_angle_degrees",
                                     "shadow_samples"};
  const std::vector<std::string_view> shapes = shape_keys(AngleForm::degrees);
  keys.insert(keys.end() - 1, shapes.begin(), shapes.end());
  const JsonObject object(node, keys);
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
