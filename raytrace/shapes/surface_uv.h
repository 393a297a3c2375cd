// Texture coordinates of a hit, and whether an alpha mask lets it pass. Sphere: u = atan2(z, x) / 2 pi
// wrapped to [0, 1), v = acos(y) / pi from the top, of the outward normal.
#pragma once

#include "raytrace/shapes/mask_cells.h"
#include "scene/texture_sample.h"
#include "scene/world.h"

namespace gnomon::raytrace {

/// Before the material's transform. `barycentric` as in Hit; `position` is used by shapes only.
Vec2 surface_uv(const World& world, std::uint32_t primitive, const Vec2& barycentric, const Vec3& position);

/// What the mesh's colours say there: linear, with alpha; white where there are none, and of shapes.
Vec4f surface_color(const World& world, std::uint32_t primitive, const Vec2& barycentric);

/// Whether a hit on a masked material is a hole: alpha < cutoff. `cells`: the material's, which save looking the texture up
/// where they are sure; or null.
bool is_masked_out(const World& world, const Material& material, const MaskCells* cells,
                   std::uint32_t primitive, const Vec2& barycentric, const Vec3& position);

}  // namespace gnomon::raytrace
