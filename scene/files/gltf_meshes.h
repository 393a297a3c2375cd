// Triangles of glTF meshes: every primitive mode, indexed or not. Points and lines are skipped, with a note.
#pragma once

#include <string>

#include "scene/expected.h"
#include "scene/files/gltf_materials.h"
#include "scene/scene.h"

namespace gnomon {

struct GltfMeshes {
  std::vector<Mesh> meshes;     ///< one for each of the model's; one without triangles is empty
  bool skipped_points = false;  ///< the model has primitives of points or lines
};

/// Primitives without a material get `default_material`.
Expected<GltfMeshes> read_gltf_meshes(Scene& scene, const tinygltf::Model& model, const TexcoordSets& sets,
                                      std::uint32_t default_material, const std::string& file);

}  // namespace gnomon
