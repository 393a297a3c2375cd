// A captured map whose picture is turned or mirrored for its reader: read another way it holds the scene. Asked before any
// caster is blamed, since the test that is drawn is the one described, and every depth is another place's.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

/// A way to read a layer's texels: columns and rows exchanged, then either run the other way.
struct MapTurn {
  bool transposed = false, columns = false, rows = false;
  bool is_none() const { return !transposed && !columns && !rows; }
};

/// Puts the number of texel from[i] in the place of texel first + i, of all that the record's test reads.
void reorder_texels(raster::LightRecord& record, std::size_t first, std::span<const std::size_t> from);

/// Turns the numbers of a face, or of the part of it that is a picture; false where that is not square and would have to be.
bool turn_face(const MapTurn& turn, int face, raster::LightRecord& record);

struct TurnedMap {
  std::string how;            ///< "mirrored left to right"
  std::string of_faces;       ///< "", or ", of layer 1" where the others are as they should be
  std::size_t wrong = 0;      ///< wrong pixels of the hard test that reads the map so
  bool counts_wrong = false;  ///< the picture is that of a hard test
};

/// Looks for turned layers where the map holds the scene at more places once it is read so, and at nearly all then.
std::optional<TurnedMap> find_turned_map(const FrameInput& input, const raster::RasterFrame& drawn,
                                         const compare::LightComparison& light);

/// That the map is turned, with what it draws otherwise; and as a sentence that says what to do.
std::string turned_map_note(const TurnedMap& turned, const compare::LightComparison& light);
std::string turned_map_cure(const TurnedMap& turned);

}  // namespace gnomon::judge
