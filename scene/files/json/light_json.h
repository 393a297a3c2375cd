// A light's shape in JSON: in scene files, in the extras of glTF files and in results, from the one list of its measures
// (scene/light_shape/light_shape.h).
#pragma once

#include <nlohmann/json.hpp>

#include "scene/files/json/json_reader.h"
#include "scene/light.h"

namespace gnomon {

/// How a sun's angle is written: "angular_diameter_degrees" as people say it, or "angular_diameter" in radians to the last bit.
enum class AngleForm : std::uint8_t { degrees, radians };

/// The light's name and type, and position and direction where the type has them.
nlohmann::ordered_json light_place_json(const Light& light);
/// The shape's measures by name: {"radius": 1, "normal": [0, -1, 0]}; null for a point.
nlohmann::ordered_json shape_measures_json(const LightExtent& extent, AngleForm form);
/// Puts the shape into a light's JSON: "disc": {...}; a sun's measures stand in the light itself.
void add_shape(nlohmann::ordered_json& light, const LightExtent& extent, AngleForm form);

/// The keys of all shapes in a light's JSON, the sun's first.
std::vector<std::string_view> shape_keys(AngleForm form);
/// Reads what add_shape() writes, and a shape's other form. A spot's disc or rectangle without a normal lies across its
/// direction, a point's faces down.
LightExtent read_shape(const JsonObject& object, const Light& light, AngleForm form);

}  // namespace gnomon
