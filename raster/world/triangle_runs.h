// Which triangles are drawn by one call: of one kind, consecutive, and not surely beside what a matrix shows. Private to
// raster.
#pragma once

#include <array>
#include <vector>

#include "raster/programs/programs.h"
#include "raster/world/stored_meshes.h"
#include "scene/math.h"

namespace gnomon::raster {

// Which boxes a clip matrix shows nothing of. What is in them need not be drawn (Assarsson and Möller 2000,
// "Optimized view frustum culling algorithms for bounding boxes", section 2). Private to raster.

/// The sides of what a clip matrix shows: left, right, top, bottom, and what is behind a perspective's eye. The near and
/// the far side are none of them, for depths are clamped there (GL_DEPTH_CLAMP).
class ClipSides {
 public:
  /// clip_from_relative: to homogeneous clip coordinates, of places that count from `reference` (world units).
  ClipSides(const Mat4& clip_from_relative, const Vec3& reference);

  /// Whether all of the box lies beyond one side, for floats as well: then its triangles cover no pixel.
  bool surely_outside(const Aabb& world_box) const;

 private:
  static constexpr std::size_t count = 5;
  Vec3 reference_;
  std::array<Vec4, count> side_;  ///< dot(side, (p, 1)) >= 0 within
  std::array<Vec4, count> size_;  ///< of the terms that floats add up for it
};

/// Consecutive triangles that share one program and its state.
struct TriangleRun {
  std::uint32_t first = 0, count = 0;  ///< by the world's numbers
  std::uint32_t at = 0;                ///< of the first one in the buffers
  std::uint32_t part = no_id;          ///< of a kept part: its number
  bool masked = false;
  bool single_sided = false;
  bool casts = true;        ///< shadows
  bool inside_out = false;  ///< of a mirrored part: fronts run clockwise
  bool follows(const TriangleRun& run) const {
    return masked == run.masked && single_sided == run.single_sided && casts == run.casts &&
           inside_out == run.inside_out && part == run.part && first == run.first + run.count &&
           at == run.at + run.count;
  }
};

class TriangleRuns {
 public:
  TriangleRuns() = default;
  /// All three must outlive this.
  TriangleRuns(const World& world, const StoredMeshes& meshes, const SceneFeatures& features);
  /// Returns the runs of blocks that may be seen, in the world's order; for a map those that cast shadows alone.
  std::vector<TriangleRun> within(const ClipSides& sides, bool casters_alone) const;

 private:
  void add(const TriangleRun& run, std::size_t block);
  const World* world_ = nullptr;
  std::vector<TriangleRun> runs_;         ///< each of one block
  std::vector<std::uint32_t> first_run_;  ///< by block, and how many there are
};

}  // namespace gnomon::raster
