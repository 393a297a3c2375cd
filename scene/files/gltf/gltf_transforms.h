// Transforms of a glTF file: of nodes, of the joints of skins, and of one node's many instances
// (EXT_mesh_gpu_instancing). Joints are taken in the pose that the nodes are stored in (glTF 2.0, section 3.7.3).
#pragma once

#include <vector>

#include "scene/base/expected.h"
#include "scene/files/formats.h"
#include "scene/files/gltf/gltf_data.h"
#include "scene/load.h"
#include "scene/math.h"

namespace gnomon {

/// The node's own transform: its matrix, or translation * rotation * scale.
Mat4 local_matrix(const gltf::Node& node);

/// world_from_node of every node, of all scenes together.
std::vector<Mat4> node_transforms(const gltf::Model& model);

/// What brings a skinned vertex into the world, by joint: world_from_joint * inverseBindMatrix. A matrix that
/// is not given is the identity.
std::vector<Mat4> joint_transforms(const gltf::Skin& skin, const std::vector<Mat4>& world_from_node,
                                   const gltf::Model& model, const GltfData& data);

/// node_from_instance of each instance; `extension` is the node's object of that name. Attributes that are not there
/// change nothing. The Error holds the reason alone.
Expected<std::vector<Mat4>> gltf_instances(const gltf::Model& model, const GltfData& data,
                                           const JsonValue& extension);

// Animations of a glTF file (glTF 2.0, section 3.11) as far as they move cameras and lights.

/// Nodes that carry what the loaded file lists, in its order.
struct CarriedNodes {
  std::vector<std::size_t> cameras, lights;
};

/// One path for each animation that moves a node; its name, or animation-I. Error (bad input): a channel or a sampler that is not sound.
Expected<std::vector<LoadedPath>> read_gltf_paths(const GltfDocument& document, const GltfData& data,
                                                  const CarriedNodes& carried, Scene& scene);

/// The nodes as the animation of that name moves them (LoadOptions::animation). Error (bad input) as above, and where there
/// is no such animation.
Expected<void> play_gltf_animation(GltfDocument& document, const GltfData& data, const LoadOptions& options);

}  // namespace gnomon
