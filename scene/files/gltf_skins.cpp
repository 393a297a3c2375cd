#include "scene/files/gltf_skins.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/files/gltf_accessor.h"

namespace gnomon {

Mat4 local_matrix(const gltf::Node& node) {
  if (node.matrix) return *node.matrix;
  Mat4 matrix(1.0);
  if (node.translation) matrix = glm::translate(matrix, *node.translation);
  if (node.rotation) {
    const glm::dquat q(node.rotation->w, node.rotation->x, node.rotation->y, node.rotation->z);
    const double length = glm::length(q);
    if (length > 0.0) matrix *= glm::mat4_cast(q / length);
  }
  if (node.scale) matrix = glm::scale(matrix, *node.scale);
  return matrix;
}

std::vector<Mat4> node_transforms(const gltf::Model& model) {
  std::vector<Mat4> world(model.nodes.size(), Mat4(1.0));
  std::vector<std::size_t> stack;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (model.nodes[i].parent < 0) stack.push_back(i), world[i] = local_matrix(model.nodes[i]);
  while (!stack.empty()) {  // no recursion: a chain of nodes may be long
    const std::size_t at = stack.back();
    stack.pop_back();
    for (const std::size_t child : model.nodes[at].children) {
      world[child] = world[at] * local_matrix(model.nodes[child]);
      stack.push_back(child);
    }
  }
  return world;
}

std::vector<Mat4> joint_transforms(const gltf::Skin& skin, const std::vector<Mat4>& world_from_node,
                                   const gltf::Model& model, const GltfData& data) {
  std::vector<Mat4> out;
  for (const std::size_t joint : skin.joints) out.push_back(world_from_node[joint]);
  if (skin.inverse_bind_matrices < 0) return out;
  GltfAccessor(model, data, skin.inverse_bind_matrices).for_each([&](std::size_t i, const double* values) {
    if (i >= out.size()) return;
    Mat4 joint_from_mesh;
    for (int c = 0; c < 16; ++c) joint_from_mesh[c / 4][c % 4] = values[c];
    out[i] *= joint_from_mesh;
  });
  return out;
}

}  // namespace gnomon
