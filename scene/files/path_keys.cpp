// {"schema": "gnomon/path/1", "camera": {"eye": KEYS, "target": KEYS, "up": KEYS},
//  "lights": {NAME: {"position": KEYS, "direction": KEYS}}}
// KEYS: {"interpolation": "linear" | "cubic" | "step", "times": [seconds], "values": [[x, y, z]]}
#include "scene/files/json/json_parts.h"

#include <fmt/core.h>

#include "scene/files/read_file.h"

namespace gnomon {
namespace {

constexpr std::string_view path_schema = "gnomon/path/1";

std::optional<KeyedVector> read_keys(const JsonObject& parent, std::string_view key) {
  const auto node = parent.find(key);
  if (!node) return {};
  const JsonObject object(*node, {"interpolation", "times", "values"});
  KeyedVector out;
  if (const auto choice = object.find("interpolation"))
    out.interpolation = static_cast<Interpolation>(choice->as_choice({"linear", "cubic", "step"}));
  if (const auto times = object.require("times"))
    for (const JsonNode& time : times->as_array()) {
      const double seconds = time.as_number(non_negative_number);
      if (!out.times.empty() && !(seconds > out.times.back())) time.error("times must rise");
      out.times.push_back(seconds);
    }
  if (const auto values = object.require("values")) {
    for (const JsonNode& value : values->as_array()) out.values.push_back(value.as_vec3());
    if (out.values.empty() || out.values.size() != out.times.size())
      values->wrong(fmt::format("got {} values", out.values.size()),
                    fmt::format("as many as times, {}, and at least one", out.times.size()));
  }
  return out;
}

void read_camera_keys(const JsonNode& node, KeyedPath& path) {
  const JsonObject object(node, {"eye", "target", "up"});
  path.eye = read_keys(object, "eye");
  path.target = read_keys(object, "target");
  path.up = read_keys(object, "up");
}

void read_light_keys(const JsonNode& node, KeyedPath& path) {
  if (!node.is(JsonValue::Type::object)) {
    node.wrong("wrong type", "an object of lights by name");
    return;
  }
  for (const JsonMember& member : node.value().members) {
    const JsonNode light(node.errors(), member.value, node.path() + "." + member.key);
    const JsonObject object(light, {"position", "direction"});
    KeyedPath::OfLight& keys = path.lights[member.key];
    keys.position = read_keys(object, "position");
    keys.direction = read_keys(object, "direction");
  }
}

// A direction of no length has no picture.
void check_directions(const JsonNode& root, const KeyedPath& path) {
  for (const auto& [name, keys] : path.lights)
    if (keys.direction)
      for (const Vec3& value : keys.direction->values)
        if (!(glm::length(value) > 0.0)) root.error(fmt::format("a direction of \"{}\" has no length", name));
  if (path.up)
    for (const Vec3& value : path.up->values)
      if (!(glm::length(value) > 0.0)) root.error("the camera's up has no length");
}

}  // namespace

void read_path_keys(const JsonObject& object, KeyedPath& path) {
  if (const auto camera = object.find("camera")) read_camera_keys(*camera, path);
  if (const auto lights = object.find("lights")) read_light_keys(*lights, path);
  check_directions(object.node(), path);
}

Expected<KeyedPath> read_path(const std::string& file) {
  auto text = read_file(file);
  if (!text) return fail(text.error());
  const auto document = parse_json(std::move(*text), file);
  if (!document) return fail(document.error());
  JsonErrors errors{*document};
  const JsonNode root(errors, document->root, "");
  const JsonObject object(root, {"schema", "camera", "lights"});
  KeyedPath path;
  if (const auto schema = object.require("schema"))
    if (schema->as_string() != path_schema) schema->wrong("unknown schema", std::string(path_schema));
  read_path_keys(object, path);
  if (errors.first) return fail(*errors.first);
  return path;
}

}  // namespace gnomon
