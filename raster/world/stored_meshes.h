// What the device's buffers hold of a world's parts and of the meshes that kept parts share. Private to raster.
#pragma once

#include <optional>
#include <vector>

#include "scene/world.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {

/// Twin of shaders/instances.glsl: what comes before the parts, and a part.
struct alignas(32) PartsHeader {
  glm::dvec4 reference{0.0};
  std::uint32_t part_count = 0, flat_vertices = 0;
};
static_assert(sizeof(PartsHeader) == sizeof(std::uint32_t) * 4 * shaders::parts_header_texel_count);
struct alignas(32) PartData {
  glm::dvec4 column[4], normal_column[3];
  std::uint32_t first_triangle, triangles_at, material, kept;
};
static_assert(sizeof(PartData) == sizeof(std::uint32_t) * 4 * shaders::part_texel_count);

/// Where a world's meshes lie in the buffers: flattened parts one after the other, then each mesh that kept parts
/// share.
struct StoredMeshes {
  struct Place {
    std::uint32_t vertices = 0, triangles = 0;
  };
  struct Stored {
    std::uint32_t part;  ///< one of those that share it
    Place at;
  };
  std::vector<Stored> stored;
  std::vector<Place> of_part;  ///< by part
  Place flat, all;             ///< how many vertices and triangles are of flattened parts, and in all
  explicit StoredMeshes(const World& world);
  /// The one that stored_material() gives for every triangle; nothing where some mesh lists materials, or where there are
  /// several.
  std::optional<std::uint32_t> material_of_all(const World& world) const;
};

PartData part_data(const WorldPart& part, const StoredMeshes::Place& at);

/// A material that triangles of kept meshes leave to their instance (shaders/instances.glsl).
inline constexpr std::uint32_t no_material = ~0u;
std::uint32_t stored_material(const WorldPart& part, std::uint32_t triangle);

}  // namespace gnomon::raster
