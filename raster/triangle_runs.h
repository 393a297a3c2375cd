// Which triangles are drawn by one call: of one kind, consecutive, and not surely beside what a matrix shows. Private to
// raster.
#pragma once

#include <vector>

#include "raster/clip_sides.h"
#include "raster/programs.h"
#include "raster/stored_meshes.h"

namespace gnomon::raster {

/// Consecutive triangles that share one program and its state.
struct TriangleRun {
  std::uint32_t first = 0, count = 0;  ///< by the world's numbers
  std::uint32_t at = 0;                ///< of the first one in the buffers
  std::uint32_t part = no_id;          ///< of a kept part: its number
  bool masked = false;
  bool single_sided = false;
  bool inside_out = false;  ///< of a mirrored part: fronts run clockwise
  bool follows(const TriangleRun& run) const {
    return masked == run.masked && single_sided == run.single_sided && inside_out == run.inside_out &&
           part == run.part && first == run.first + run.count && at == run.at + run.count;
  }
};

class TriangleRuns {
 public:
  TriangleRuns() = default;
  /// All three must outlive this.
  TriangleRuns(const World& world, const StoredMeshes& meshes, const SceneFeatures& features);
  /// Those of blocks that may be seen, in the world's order.
  std::vector<TriangleRun> within(const ClipSides& sides) const;

 private:
  void add(const TriangleRun& run, std::size_t block);
  const World* world_ = nullptr;
  std::vector<TriangleRun> runs_;         ///< each of one block
  std::vector<std::uint32_t> first_run_;  ///< by block, and how many there are
};

}  // namespace gnomon::raster
