// What Gnomon's own glTF files say beyond glTF, in "extras": {"gnomon": ...}:
//   the file    ambient, background, exposure, max_depth, glossy_samples, indirect_samples
//   a camera    target and up in the world, as long as the node agrees with them; samples_per_pixel
//   a light     angular_diameter (radians) | sphere {radius} | disc {radius, normal} | rectangle {half_width,
//               half_height}, all in the world; shadow_samples
//   a material  the numbers of Blinn-Phong, mirror and transmission, as a JSON scene has them; these replace
//               what the glTF material would be mapped to
// Besides, in the extras themselves and whatever the generator, a node and a material have casts_shadow and receives_shadow
// (gltf_value.h). The others are read only where asset.generator is Gnomon: another program that has rewritten the file may have
// changed what they belong to.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "scene/files/json/json_reader.h"
#include "scene/scene.h"

namespace gnomon {

inline constexpr std::string_view gltf_generator = "Gnomon";

nlohmann::ordered_json scene_extras(const Scene& scene);
nlohmann::ordered_json camera_extras(const Camera& camera);
/// Empty for a hard light.
nlohmann::ordered_json light_extras(const Light& light);
nlohmann::ordered_json material_extras(const Material& material);

/// Reads them back; mistakes go to JsonErrors.
class GltfExtras {
 public:
  GltfExtras(JsonErrors& errors, const JsonValue& root);
  void read_scene(Scene& scene) const;
  void read_camera(std::size_t index, Camera& camera) const;
  void read_light(std::size_t index, Light& light) const;
  void read_material(std::size_t index, Material& material) const;

 private:
  std::optional<JsonNode> of(const JsonNode& owner) const;
  std::optional<JsonNode> of_item(const std::vector<JsonNode>& list, std::size_t index) const;

  JsonNode root_;
  bool ours_ = false;
  std::vector<JsonNode> cameras_, lights_, materials_;
};

}  // namespace gnomon
