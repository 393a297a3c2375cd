// Skins of glTF files, in the pose that the nodes are stored in (glTF 2.0, section 3.7.3).
#pragma once

#include <vector>

#include "scene/files/gltf_data.h"
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

}  // namespace gnomon
