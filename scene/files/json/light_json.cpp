#include "scene/files/json/light_json.h"

#include <optional>
#include <utility>

namespace gnomon {
namespace {

using Json = nlohmann::ordered_json;
using Kind = ShapeMeasure::Kind;

constexpr double half_turn_degrees = 180.0;

template <std::size_t... i>
std::vector<LightExtent> shapes_by_row(std::index_sequence<i...>) {
  return {std::variant_alternative_t<i, LightExtent>{}...};
}

/// One of each kind, in the table's order.
std::vector<LightExtent> all_shapes() {
  return shapes_by_row(std::make_index_sequence<std::variant_size_v<LightExtent>>{});
}

std::string_view measure_key(const ShapeMeasure& measure, AngleForm form) {
  return measure.kind == Kind::angle && form == AngleForm::degrees ? measure.degrees_key : measure.key;
}

/// What stands for the shape in a light's JSON; "" of a point.
std::string_view light_key(LightExtent& shape, AngleForm form) {
  if (std::holds_alternative<PointShape>(shape)) return {};
  return is_sun_shape(shape) ? measure_key(shape_measures(shape).front(), form) : shape_name(shape);
}

Json vector_json(const Vec3& v) {
  return {v.x, v.y, v.z};
}

/// A unit vector as it is, to the last bit; any other made one.
Vec3 read_normal(const JsonNode& node) {
  const Vec3 given = node.as_vec3();
  constexpr double rounding = 0x1p-50;
  return std::abs(glm::dot(given, given) - 1.0) < rounding ? given : node.as_direction();
}

Vec3 default_normal(const Light& light) {
  return light.type == LightType::spot ? light.direction : Vec3(0.0, -1.0, 0.0);
}

void read_measure(const JsonNode& node, const ShapeMeasure& measure, AngleForm form) {
  switch (measure.kind) {
    case Kind::length:
      *measure.number = node.as_number({0.0, max_coordinate});
      break;
    case Kind::angle:
      *measure.number = form == AngleForm::radians
                            ? node.as_number({0.0, 0.5 * pi})
                            : node.as_number({0.0, 0.5 * half_turn_degrees}) * pi / half_turn_degrees;
      break;
    case Kind::normal:
      *measure.vector = read_normal(node);
      break;
    case Kind::side:
      *measure.vector = node.as_vec3();
      break;
  }
}

void read_measures(const JsonObject& object, const Light& light, LightExtent& shape, AngleForm form) {
  for (const ShapeMeasure& measure : shape_measures(shape)) {
    const std::string_view key = measure_key(measure, form);
    const bool has_default = measure.kind == Kind::normal && !object.has(key);
    if (has_default)
      *measure.vector = default_normal(light);
    else if (const auto node = object.require(key))
      read_measure(*node, measure, form);
  }
}

void read_lamp(const JsonNode& node, const Light& light, LightExtent& shape, AngleForm form) {
  std::vector<std::string_view> keys;
  for (const ShapeMeasure& measure : shape_measures(shape)) keys.push_back(measure_key(measure, form));
  const auto read_any = [&](auto& own) {
    if constexpr (requires { own.form_keys; }) {
      keys.insert(keys.end(), std::begin(own.form_keys), std::end(own.form_keys));
      const JsonObject object(node, keys);
      const auto normal = object.find("normal");
      if (own.read_form(object, normal ? read_normal(*normal) : default_normal(light))) return;
      for (const std::string_view key : own.form_keys)
        object.forbid(key, "cannot stand beside half_width and half_height");
      read_measures(object, light, shape, form);
    } else {
      read_measures(JsonObject(node, keys), light, shape, form);
    }
  };
  std::visit(read_any, shape);
}

}  // namespace

Json light_place_json(const Light& light) {
  Json json{{"name", light.name}, {"type", light_type_name(light.type)}};
  if (light.type != LightType::directional) json["position"] = vector_json(light.position);
  if (light.type != LightType::point) json["direction"] = vector_json(light.direction);
  return json;
}

Json shape_measures_json(const LightExtent& extent, AngleForm form) {
  LightExtent shape = extent;
  Json json;
  for (const ShapeMeasure& measure : shape_measures(shape)) {
    Json& value = json[std::string(measure_key(measure, form))];
    if (measure.vector != nullptr)
      value = vector_json(*measure.vector);
    else
      value = measure.kind == Kind::angle && form == AngleForm::degrees
                  ? *measure.number * half_turn_degrees / pi
                  : *measure.number;
  }
  return json;
}

void add_shape(Json& light, const LightExtent& extent, AngleForm form) {
  Json measures = shape_measures_json(extent, form);
  if (is_sun_shape(extent))
    light.update(measures);
  else if (!measures.is_null())
    light[std::string(shape_name(extent))] = std::move(measures);
}

std::vector<std::string_view> shape_keys(AngleForm form) {
  std::vector<std::string_view> keys;
  for (LightExtent& shape : all_shapes())
    if (const std::string_view key = light_key(shape, form); !key.empty()) keys.push_back(key);
  return keys;
}

LightExtent read_shape(const JsonObject& object, const Light& light, AngleForm form) {
  const bool directional = light.type == LightType::directional;
  std::vector<std::string_view> keys;
  LightExtent found;
  for (LightExtent& shape : all_shapes()) {
    const std::string_view key = light_key(shape, form);
    if (key.empty()) continue;
    if (is_sun_shape(shape) != directional) {
      object.forbid(
          key, directional ? "does not apply to a directional light" : "applies to a directional light only");
      continue;
    }
    keys.push_back(key);
    if (object.has(key)) found = shape;
  }
  if (std::holds_alternative<PointShape>(found)) return {};
  const std::string_view given = object.exactly_one(keys);
  if (given.empty()) return {};
  if (directional)
    read_measures(object, light, found, form);
  else
    read_lamp(*object.find(given), light, found, form);
  return found;
}

}  // namespace gnomon
