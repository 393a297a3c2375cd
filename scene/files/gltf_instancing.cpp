#include "scene/files/gltf_instancing.h"

#include <fmt/core.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "scene/files/gltf_accessor.h"
#include "scene/files/gltf_value.h"

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
