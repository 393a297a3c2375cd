#include "scene/files/gltf_skins.h"

#include <tiny_gltf.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/files/gltf_accessor.h"

namespace gnomon {

Mat4 local_matrix(const tinygltf::Model& model, std::size_t index) {
  const tinygltf::Node& node = model.nodes[index];
  Mat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  if (node.translation.size() == 3)
    matrix = glm::translate(matrix, Vec3(node.translation[0], node.translation[1], node.translation[2]));
  if (node.rotation.size() == 4) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (length > 0.0) matrix *= glm::mat4_cast(q / length);
  }
  if (node.scale.size() == 3) matrix = glm::scale(matrix, Vec3(node.scale[0], node.scale[1], node.scale[2]));
  return matrix;
}

std::vector<Mat4> node_transforms(const tinygltf::Model& model) {
  std::vector<char> has_parent(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes)
    for (const int child : node.children) has_parent[static_cast<std::size_t>(child)] = 1;
  std::vector<Mat4> world(model.nodes.size(), Mat4(1.0));
  std::vector<std::size_t> stack;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (has_parent[i] == 0) stack.push_back(i), world[i] = local_matrix(model, i);
  while (!stack.empty()) {  // no recursion: a chain of nodes may be long
    const std::size_t at = stack.back();
    stack.pop_back();
    for (const int child : model.nodes[at].children) {
      const auto c = static_cast<std::size_t>(child);
      world[c] = world[at] * local_matrix(model, c);
      stack.push_back(c);
    }
  }
  return world;
}

std::vector<Mat4> joint_transforms(const JsonValue& skin, const std::vector<Mat4>& world_from_node,
                                   const tinygltf::Model& model, const GltfData& data) {
  std::vector<Mat4> out;
  for (const JsonValue& joint : gltf_list(skin, "joints"))
    out.push_back(world_from_node[static_cast<std::size_t>(joint.number)]);
  const double inverse = number_of(&skin, "inverseBindMatrices", -1.0);
  if (inverse < 0.0) return out;
  GltfAccessor(model, data, static_cast<int>(inverse)).for_each([&](std::size_t i, const double* values) {
    if (i >= out.size()) return;
    Mat4 joint_from_mesh;
    for (int c = 0; c < 16; ++c) joint_from_mesh[c / 4][c % 4] = values[c];
    out[i] *= joint_from_mesh;
  });
  return out;
}

}  // namespace gnomon
