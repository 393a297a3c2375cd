// MTL materials of an OBJ file, mapped to ours. The mapping:
//   Kd, Ks, Ke      diffuse, specular, emission; a material without Kd is neutral grey
//   Ns              shininess, at least 1
//   d (or 1 - Tr)   below 1: transmission = 1 - d, with the index of refraction Ni
//   illum 3, 5, 7   mirror = the mean of Ks, as far as transmission leaves room
//   illum 4, 6, 7   glass: with d = 1, transmission = the mean of Tf
//   map_Kd, map_d   diffuse texture and mask (obj_textures.h)
// Other maps are noted as not used.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "scene/load.h"

namespace tinyobj {
struct material_t;
}

namespace gnomon {

/// Appends the materials (and their textures) to the scene, in order. `without_diffuse`: names of materials
/// that give no Kd.
Expected<void> add_obj_materials(Scene& scene, const std::vector<tinyobj::material_t>& materials,
                                 const std::set<std::string>& without_diffuse, const std::string& folder,
                                 const LoadOptions& options);

}  // namespace gnomon
