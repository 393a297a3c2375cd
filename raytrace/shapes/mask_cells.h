// Where an alpha mask is surely opaque and where surely a hole. Packets (raytrace/packets/) know a hit's place in the texture to
// within a texel and ask nothing else; a single ray needs no lookup then (is_masked_out).
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "scene/texture_sample.h"
#include "scene/world.h"

namespace gnomon::raytrace {

enum class MaskKind : std::uint8_t { mixed = 0, opaque = 1, hole = 2 };

/// Cells of the lattice of texel centres: cell (i, j) lies between the centres of texels i and i + 1, and j and j + 1. A cell's
/// kind holds for all lookups (scene/texture_sample.h) in the cell and up to a whole texel around it, where the colours of the
/// vertices leave alpha alone. A byte for each texel.
class MaskCells {
 public:
  /// None.
  MaskCells() = default;
  /// Makes the cells of a material with AlphaMode::mask.
  MaskCells(const Scene& scene, const Material& material);

  bool empty() const { return kinds_.empty(); }
  std::uint64_t bytes() const { return kinds_.size(); }
  /// Returns the size of the texture, texels; 1 x 1 where the material has none.
  ImageSize size() const { return size_; }
  bool repeats_s() const { return repeat_s_; }
  bool repeats_t() const { return repeat_t_; }
  /// At texture coordinates, after the material's transform.
  MaskKind at(const Vec2& uv) const {
    const Vec2 place = glm::floor(Vec2(size_.width, size_.height) * uv - 0.5);
    constexpr double farthest = 0x1p30;
    if (!(std::abs(place.x) < farthest && std::abs(place.y) < farthest)) return MaskKind::mixed;
    return at(static_cast<int>(place.x), static_cast<int>(place.y));
  }
  /// Any cells: the texture is repeated, or its edges are.
  MaskKind at(int i, int j) const {
    const auto column = static_cast<std::size_t>(wrapped(i, size_.width, repeat_s_));
    const auto row = static_cast<std::size_t>(wrapped(j, size_.height, repeat_t_));
    return static_cast<MaskKind>(kinds_[row * static_cast<std::size_t>(size_.width) + column]);
  }

 private:
  static int wrapped(int i, int count, bool repeat) {
    if (static_cast<unsigned>(i) < static_cast<unsigned>(count)) [[likely]]
      return i;
    if (!repeat) return i < 0 ? 0 : count - 1;
    const int rest = i % count;
    return rest < 0 ? rest + count : rest;
  }
  void widen_rows();
  void widen_columns();

  ImageSize size_{0, 0};
  bool repeat_s_ = false, repeat_t_ = false;
  std::vector<std::uint8_t> kinds_;  ///< row by row
};

/// By the scene's materials; none for those without mask.
std::vector<MaskCells> mask_cells(const Scene& scene);

// Texture coordinates of a hit, and whether an alpha mask lets it pass. Sphere: u = atan2(z, x) / 2 pi
// wrapped to [0, 1), v = acos(y) / pi from the top, of the outward normal.

/// Before the material's transform. `barycentric` as in Hit; `position` is used by shapes only.
Vec2 surface_uv(const World& world, std::uint32_t primitive, const Vec2& barycentric, const Vec3& position);

/// What the mesh's colours say there: linear, with alpha; white where there are none, and of shapes.
Vec4f surface_color(const World& world, std::uint32_t primitive, const Vec2& barycentric);

/// Whether a hit on a masked material is a hole: alpha < cutoff. `cells`: the material's, which save looking the texture up
/// where they are sure; or null.
bool is_masked_out(const World& world, const Material& material, const MaskCells* cells,
                   std::uint32_t primitive, const Vec2& barycentric, const Vec3& position);

}  // namespace gnomon::raytrace
