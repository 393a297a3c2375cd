// A scene as a glTF 2.0 file, whole in itself: buffers and textures are inside it. What glTF has no words for
// (lights with a size, Blinn-Phong's own numbers, the picture's settings) stands in its "extras", which
// read_gltf understands (gltf_extras.h).
#pragma once

#include <string>
#include <vector>

#include "scene/base/expected.h"
#include "scene/scene.h"

namespace gnomon {

struct GltfFile {
  std::string bytes;
  std::vector<std::string> notes;  ///< what others will not read as it is here, one sentence each
};

/// `binary`: GLB, otherwise JSON with data URIs. The same scene gives the same bytes. Instances that share a
/// mesh share it in the file; positions are stored as floats, transforms as they are. Requires that the scene
/// has no shapes (scene/shapes/tessellate.h). ErrorKind::cannot_write where a GLB cannot hold the scene (4 GiB).
Expected<GltfFile> write_gltf(const Scene& scene, bool binary);

}  // namespace gnomon
