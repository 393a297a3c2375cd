// Which triangles may meet which tile of one face of the map: a counting sort over all threads.
#pragma once

#include <span>
#include <vector>

#include "hybrid/sheet_grid.h"

namespace gnomon::hybrid {

class TileBins {
 public:
  TileBins(const World& world, const SheetGrid& grid, const std::vector<ProjectedPoint>& points);
  /// Ascending ids. `tile`: row by row on the face.
  std::span<const std::uint32_t> triangles(std::size_t tile) const {
    return {triangles_.data() + first_[tile], triangles_.data() + first_[tile + 1]};
  }

  std::uint64_t bytes() const {
    return first_.size() * sizeof(std::uint64_t) + triangles_.size() * sizeof(std::uint32_t);
  }

 private:
  std::vector<std::uint64_t> first_;  // of each tile
  std::vector<std::uint32_t> triangles_;
};

}  // namespace gnomon::hybrid
