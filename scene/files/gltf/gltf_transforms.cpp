#include "scene/files/gltf/gltf_transforms.h"

#include <fmt/core.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "scene/files/gltf/gltf_accessor.h"
#include "scene/files/gltf/gltf_value.h"

namespace gnomon {
namespace {

/// None where the attribute is not there.
Expected<std::optional<int>> find(const gltf::Model& model, const JsonValue* attributes,
                                  const std::string& name, gltf::ElementType type) {
  if (!has(attributes, name)) return std::nullopt;
  const int index = index_of(attributes, name, model.accessors.size());
  if (index < 0) return fail(ErrorKind::bad_input, fmt::format("{}: there is no such accessor", name));
  const gltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  if (accessor.type != type)
    return fail(ErrorKind::bad_input, fmt::format("{}: the accessor's type does not fit", name));
  if (accessor.view < 0)
    return fail(ErrorKind::bad_input, fmt::format("{}: the accessor has no bufferView", name));
  return index;
}

Mat4 rotation(const double* q) {
  const glm::dquat turn(q[3], q[0], q[1], q[2]);
  const double length = glm::length(turn);
  return length > 0.0 ? glm::mat4_cast(turn / length) : Mat4(1.0);
}

}  // namespace

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

Expected<std::vector<Mat4>> gltf_instances(const gltf::Model& model, const GltfData& data,
                                           const JsonValue& extension) {
  if (!has(&extension, "attributes")) return fail(ErrorKind::bad_input, "attributes is missing");
  const JsonValue* attributes = member(&extension, "attributes");
  const auto translations = find(model, attributes, "TRANSLATION", gltf::ElementType::vec3);
  const auto rotations = find(model, attributes, "ROTATION", gltf::ElementType::vec4);
  const auto scales = find(model, attributes, "SCALE", gltf::ElementType::vec3);
  for (const auto* found : {&translations, &rotations, &scales})
    if (!*found) return fail(found->error());
  std::optional<std::size_t> count;
  for (const auto* found : {&translations, &rotations, &scales}) {
    if (!**found) continue;
    const std::size_t own = model.accessors[static_cast<std::size_t>(***found)].count;
    if (count.value_or(own) != own) return fail(ErrorKind::bad_input, "the attributes' counts differ");
    count = own;
  }
  std::vector<Mat4> out(count.value_or(0), Mat4(1.0));
  const auto apply = [&](const std::optional<int>& accessor, auto&& change) {
    if (!accessor) return;
    GltfAccessor(model, data, *accessor).for_each([&](std::size_t i, const double* v) {
      out[i] = change(out[i], v);
    });
  };
  apply(*translations,
        [](const Mat4& m, const double* v) { return glm::translate(m, Vec3(v[0], v[1], v[2])); });
  apply(*rotations, [](const Mat4& m, const double* v) { return m * rotation(v); });
  apply(*scales, [](const Mat4& m, const double* v) { return glm::scale(m, Vec3(v[0], v[1], v[2])); });
  return out;
}

}  // namespace gnomon
