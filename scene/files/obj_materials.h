// MTL materials of an OBJ file, mapped to ours. The mapping:
//   Kd, Ks, Ke      diffuse, specular, emission; a material without Kd is neutral grey
//   Ns              shininess, at least 1
//   d (or 1 - Tr)   below 1: transmission = 1 - d, with the index of refraction Ni
//   illum 3, 5, 7   mirror = the mean of Ks, as far as transmission leaves room
//   illum 4, 6, 7   glass: with d = 1, transmission = the mean of Tf
//   map_Kd, map_d   diffuse texture and mask (obj_textures.h)
// Other maps are noted as not used.
#pragma once

#include <string>
#include <vector>

#include "scene/files/mtl.h"
#include "scene/load.h"

namespace gnomon {

/// Appends the materials (and their textures) to the scene, in order.
Expected<void> add_obj_materials(Scene& scene, const std::vector<MtlMaterial>& materials,
                                 const std::string& folder, const LoadOptions& options);

}  // namespace gnomon
