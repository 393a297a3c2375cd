// glTF materials, mapped to Blinn-Phong with mirror and transmission. With base, metallic and roughness from
// pbrMetallicRoughness (a metallicRoughnessTexture enters by its mean), a = max(roughness^2, 0.01):
//   diffuse      base (1 - metallic), times the base colour texture
//   specular     mix(0.04 KHR_materials_specular, base, metallic); of a textured metal, base times its mean
//   shininess    2 / a^2 - 2, at least 1: the exponent whose lobe is as wide (Walter et al. 2007, "Microfacet
//   Models
//                for Refraction through Rough Surfaces", EGSR, section 5.2)
//   mirror       of a smooth metal (metallic > 0.9, roughness < 0.1): the mean of base
//   transmission KHR_materials_transmission; with a volume it refracts with KHR_materials_ior and absorbs
//                -ln(attenuationColor) / attenuationDistance; without one it is a thin sheet: index 1, and
//                the share
//                ((ior - 1) / (ior + 1))^2 is mirror
//   emission     emissiveFactor times KHR_materials_emissive_strength, times the emissive texture
//   unlit        KHR_materials_unlit: the base colour, and nothing else
//   double_sided doubleSided
//   alpha        MASK as it is. BLEND: a material of one alpha becomes a thin sheet with transmission 1 -
//   alpha; one
//                with alpha in its texture becomes a mask at 0.5
// What else the file gives (normal and occlusion textures ...) is noted as not used.
#pragma once

#include <string>

#include "scene/base/expected.h"
#include "scene/files/gltf/gltf_data.h"
#include "scene/scene.h"

namespace gnomon {

/// Which set of texture coordinates each material's base colour texture uses, by glTF material index.
using TexcoordSets = std::vector<int>;

/// Appends every material of the file and the textures that they use.
Expected<TexcoordSets> add_gltf_materials(Scene& scene, const JsonDocument& json, GltfData& data);

}  // namespace gnomon
