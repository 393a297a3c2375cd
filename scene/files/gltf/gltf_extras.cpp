#include "scene/files/gltf/gltf_extras.h"

#include "scene/camera.h"
#include "scene/files/gltf/gltf_writer_parts.h"
#include "scene/files/json/light_json.h"

namespace gnomon {
namespace {

using gltf_writer::array;
using gltf_writer::shortest;
using Json = nlohmann::ordered_json;

Json wrapped(Json gnomon) {
  return {{"gnomon", std::move(gnomon)}};
}

int whole(const JsonObject& object, std::string_view key, int otherwise, NumberRange range) {
  range.whole = true;
  return static_cast<int>(object.number(key, otherwise, range));
}

/// Both see the same picture, up to the rounding of a node's matrix to floats by whoever moved it.
bool same_view(const Camera& a, const Camera& b) {
  constexpr double close = 1e-6;
  const View x = make_view(a, {1, 1}), y = make_view(b, {1, 1});
  return glm::distance(x.forward, y.forward) < close && glm::distance(x.up, y.up) < close;
}

}  // namespace

nlohmann::ordered_json scene_extras(const Scene& scene) {
  Json out{{"ambient", shortest(scene.ambient)}, {"background", shortest(scene.background)}};
  if (scene.exposure) out["exposure"] = *scene.exposure;
  out["max_depth"] = scene.max_depth;
  out["glossy_samples"] = scene.glossy_samples;
  out["indirect_samples"] = scene.indirect_samples;
  return wrapped(std::move(out));
}

nlohmann::ordered_json camera_extras(const Camera& camera) {
  return wrapped({{"target", array(camera.target)},
                  {"up", array(camera.up)},
                  {"samples_per_pixel", camera.samples_per_pixel}});
}

nlohmann::ordered_json light_extras(const Light& light) {
  Json out;
  add_shape(out, light.extent, AngleForm::radians);
  if (out.is_null()) return out;
  out["shadow_samples"] = light.shadow_samples;
  return wrapped(std::move(out));
}

nlohmann::ordered_json material_extras(const Material& m) {
  return wrapped({{"diffuse", shortest(m.diffuse)},
                  {"specular", shortest(m.specular)},
                  {"shininess", shortest(m.shininess)},
                  {"emission", shortest(m.emission)},
                  {"mirror", shortest(m.mirror)},
                  {"transmission", shortest(m.transmission)},
                  {"ior", shortest(m.ior)},
                  {"absorption", shortest(m.absorption)},
                  {"roughness", shortest(m.roughness)},
                  {"priority", m.priority},
                  {"thin", m.thin},
                  {"double_sided", m.double_sided}});
}

GltfExtras::GltfExtras(JsonErrors& errors, const JsonValue& root) : root_(errors, root, "") {
  const auto asset = root_.child("asset");
  const auto generator = asset ? asset->child("generator") : std::nullopt;
  ours_ = generator && generator->value().text == gltf_generator;
  if (!ours_) return;
  if (const auto list = root_.child("cameras")) cameras_ = list->as_array();
  if (const auto list = root_.child("materials")) materials_ = list->as_array();
  const auto extensions = root_.child("extensions");
  const auto punctual = extensions ? extensions->child("KHR_lights_punctual") : std::nullopt;
  const auto lights = punctual ? punctual->child("lights") : std::nullopt;
  if (lights) lights_ = lights->as_array();
}

std::optional<JsonNode> GltfExtras::of(const JsonNode& owner) const {
  const auto extras = ours_ ? owner.child("extras") : std::nullopt;
  return extras ? extras->child("gnomon") : std::nullopt;
}

std::optional<JsonNode> GltfExtras::of_item(const std::vector<JsonNode>& list, std::size_t index) const {
  return index < list.size() ? of(list[index]) : std::nullopt;
}

void GltfExtras::read_scene(Scene& scene) const {
  const auto node = of(root_);
  if (!node) return;
  const JsonObject object(
      *node, {"ambient", "background", "exposure", "max_depth", "glossy_samples", "indirect_samples"});
  scene.ambient = object.color("ambient", scene.ambient);
  scene.background = object.color("background", scene.background);
  if (const auto exposure = object.find("exposure"))
    scene.exposure = exposure->as_number({0.0, max_radiance, true});
  scene.max_depth = whole(object, "max_depth", scene.max_depth, {0.0, 64.0});
  scene.glossy_samples = whole(object, "glossy_samples", scene.glossy_samples, {1.0, max_samples});
  scene.indirect_samples = whole(object, "indirect_samples", scene.indirect_samples, {0.0, max_samples});
}

void GltfExtras::read_camera(std::size_t index, Camera& camera) const {
  const auto node = of_item(cameras_, index);
  if (!node) return;
  const JsonObject object(*node, {"target", "up", "samples_per_pixel"});
  Camera said = camera;
  if (const auto target = object.find("target")) said.target = target->as_vec3();
  if (const auto up = object.find("up")) said.up = up->as_vec3();
  if (!find_camera_defect(said) && same_view(said, camera)) camera = said;
  camera.samples_per_pixel = whole(object, "samples_per_pixel", 1, {1.0, max_samples});
}

void GltfExtras::read_light(std::size_t index, Light& light) const {
  const auto node = of_item(lights_, index);
  if (!node) return;
  std::vector<std::string_view> keys = shape_keys(AngleForm::radians);
  keys.push_back("shadow_samples");
  const JsonObject object(*node, keys);
  light.extent = read_shape(object, light, AngleForm::radians);
  light.shadow_samples = whole(object, "shadow_samples", light.shadow_samples, {1.0, max_shadow_samples});
}

void GltfExtras::read_material(std::size_t index, Material& material) const {
  const auto node = of_item(materials_, index);
  if (!node) return;
  const JsonObject object(*node, {"diffuse", "specular", "shininess", "emission", "mirror", "transmission",
                                  "ior", "absorption", "roughness", "priority", "thin", "double_sided"});
  const auto number = [&](std::string_view key, float& field) {
    field = static_cast<float>(object.number(key, static_cast<double>(field)));
  };
  material.diffuse = object.color("diffuse", material.diffuse);
  material.specular = object.color("specular", material.specular);
  material.emission = object.color("emission", material.emission);
  material.absorption = object.color("absorption", material.absorption);
  number("shininess", material.shininess);
  number("mirror", material.mirror);
  number("transmission", material.transmission);
  number("ior", material.ior);
  number("roughness", material.roughness);
  material.priority = whole(object, "priority", material.priority, {-1000.0, 1000.0});
  material.thin = object.boolean("thin", material.thin);
  material.double_sided = object.boolean("double_sided", material.double_sided);
}

}  // namespace gnomon
