#include "scene/files/repeated_instances.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <unordered_set>
#include <vector>

namespace gnomon {
namespace {

/// All that tells what is seen of an instance, as bytes.
std::string key_of(const MeshInstance& instance) {
  const Mat4& matrix = instance.world_from_object;
  std::string key(sizeof matrix + sizeof instance.mesh + sizeof instance.material, '\0');
  char* const to = key.data();
  std::memcpy(to, &matrix, sizeof matrix);
  std::memcpy(to + sizeof matrix, &instance.mesh, sizeof instance.mesh);
  std::memcpy(to + sizeof matrix + sizeof instance.mesh, &instance.material, sizeof instance.material);
  return key;
}

bool is_glass(const Scene& scene, std::uint32_t material) {
  return material < scene.materials.size() && scene.materials[material].transmission > 0.0f;
}

/// Whether light goes through some of each mesh's own materials.
std::vector<bool> meshes_of_glass(const Scene& scene) {
  std::vector<bool> glass;
  for (const Mesh& mesh : scene.meshes)
    glass.push_back(std::ranges::any_of(mesh.triangle_materials,
                                        [&](std::uint32_t material) { return is_glass(scene, material); }));
  return glass;
}

}  // namespace

void leave_out_repeated_instances(Scene& scene) {
  const std::vector<bool> glass = meshes_of_glass(scene);
  std::unordered_set<std::string> seen;
  std::string first;
  const std::size_t repeated = std::erase_if(scene.instances, [&](const MeshInstance& instance) {
    if (glass[instance.mesh] || is_glass(scene, instance.material)) return false;
    const bool again = !seen.insert(key_of(instance)).second;
    if (again && first.empty()) first = instance.name;
    return again;
  });
  if (repeated == 0) return;
  scene.notes.push_back(fmt::format("{} of {} nodes repeat another exactly and are left out{}.", repeated,
                                    repeated + scene.instances.size(),
                                    first.empty() ? "" : fmt::format(" (the first is {})", first)));
}

}  // namespace gnomon
