#include "raster/world/stored_meshes.h"

#include <algorithm>
#include <map>

namespace gnomon::raster {

StoredMeshes::StoredMeshes(const World& world) : of_part(world.parts.size()) {
  const auto store = [&](std::uint32_t part) {
    stored.push_back({part, all}), of_part[part] = all;
    all.vertices += world.parts[part].vertex_count(), all.triangles += world.parts[part].triangle_count();
  };
  for (std::uint32_t i = 0; i < world.parts.size(); ++i)
    if (!world.parts[i].kept()) store(i);
  flat = all;
  std::map<const Mesh*, std::uint32_t> first_of;
  for (std::uint32_t i = 0; i < world.parts.size(); ++i) {
    if (!world.parts[i].kept()) continue;
    const auto [found, is_new] = first_of.try_emplace(world.parts[i].mesh, i);
    if (is_new) store(i);
    of_part[i] = of_part[found->second];
  }
}

std::uint32_t stored_material(const WorldPart& part, std::uint32_t triangle) {
  return part.kept() && part.mesh->triangle_materials.empty() ? no_material : part.material_of(triangle);
}

std::optional<std::uint32_t> StoredMeshes::material_of_all(const World& world) const {
  std::optional<std::uint32_t> every;
  for (const Stored& s : stored) {
    const WorldPart& part = world.parts[s.part];
    if (part.triangle_count() == 0) continue;
    const std::uint32_t material = stored_material(part, 0);
    if (!part.mesh->triangle_materials.empty() || every.value_or(material) != material) return std::nullopt;
    every = material;
  }
  return every;
}

PartData part_data(const WorldPart& part, const StoredMeshes::Place& at) {
  PartData out{};
  for (int c = 0; c < 4; ++c) out.column[c] = part.world_from_object[c];
  for (int c = 0; c < 3; ++c) out.normal_column[c] = Vec4(part.normal_from_object[c], 0.0);
  out.first_triangle = part.first_triangle, out.triangles_at = at.triangles, out.material = part.material;
  out.kept = part.kept() ? 1 : 0;
  return out;
}

}  // namespace gnomon::raster
