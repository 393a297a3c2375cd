#include "scene/files/gltf_extensions.h"

#include <algorithm>

namespace gnomon {

const std::vector<std::string_view>& supported_extensions() {
  static const std::vector<std::string_view> names{"KHR_lights_punctual",
                                                   "KHR_materials_transmission",
                                                   "KHR_materials_ior",
                                                   "KHR_materials_volume",
                                                   "KHR_materials_emissive_strength",
                                                   "KHR_materials_specular",
                                                   "KHR_materials_unlit",
                                                   "KHR_texture_transform",
                                                   "KHR_mesh_quantization",
                                                   "KHR_texture_basisu",
                                                   "KHR_draco_mesh_compression",
                                                   "EXT_meshopt_compression",
                                                   "KHR_meshopt_compression",
                                                   "KHR_node_visibility",
                                                   "EXT_mesh_gpu_instancing",
                                                   "EXT_texture_webp",
                                                   "KHR_materials_pbrSpecularGlossiness"};
  return names;
}

bool is_supported_extension(const std::string& name) {
  const auto& names = supported_extensions();
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_spared_extension(const std::string& name) {
  static const std::vector<std::string_view> names{
      "KHR_materials_clearcoat",   "KHR_materials_sheen",      "KHR_materials_anisotropy",
      "KHR_materials_iridescence", "KHR_materials_dispersion", "KHR_materials_diffuse_transmission",
      "KHR_materials_variants",    "KHR_animation_pointer",    "KHR_xmp_json_ld",
      "KHR_node_hoverability",     "KHR_node_selectability"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace gnomon
