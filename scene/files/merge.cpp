#include "scene/files/json/json_parts.h"

#include <iterator>

namespace gnomon {
namespace {

template <class T>
void append(std::vector<T>& into, std::vector<T>&& from) {
  into.insert(into.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

MergeOffsets merge_scene(Scene& into, Scene&& from, bool placed) {
  const MergeOffsets offsets{static_cast<std::uint32_t>(into.materials.size()),
                             static_cast<std::uint32_t>(into.textures.size()),
                             static_cast<std::uint32_t>(into.meshes.size())};
  for (Material& material : from.materials)
    for (std::uint32_t* texture : {&material.diffuse_texture, &material.emission_texture})
      if (*texture != no_id) *texture += offsets.texture;
  for (Mesh& mesh : from.meshes)
    for (std::uint32_t& material : mesh.triangle_materials) material += offsets.material;
  append(into.materials, std::move(from.materials));
  append(into.textures, std::move(from.textures));
  append(into.meshes, std::move(from.meshes));
  append(into.notes, std::move(from.notes));
  if (!placed) return offsets;
  for (MeshInstance& instance : from.instances) {
    instance.mesh += offsets.mesh;
    instance.material += offsets.material;
  }
  for (Shape& shape : from.shapes) shape.material += offsets.material;
  append(into.instances, std::move(from.instances));
  append(into.shapes, std::move(from.shapes));
  append(into.lights, std::move(from.lights));
  return offsets;
}

}  // namespace gnomon
