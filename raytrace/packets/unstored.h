// Receivers that a frame does not store: where only the picture is wanted, each tile's are found again from
// the primitives that its pixels see, bit for bit as they were, and live no longer than the tile is worked
// on. They are 96 bytes a pixel, which to clear and to page in takes longer than to find them twice.
#pragma once

#include "raytrace/huge_array.h"
#include "raytrace/packets/passes.h"

namespace gnomon::raytrace {

struct UnstoredReceivers {
  HugeArray<TileHits> hits;  ///< by tile; empty: the receivers are stored
  int first_row = 0;         ///< as PrimarySinks has it

  bool apply() const { return hits.size() > 0; }
  ReceiverSource source(const Tracer& tracer, const View& view, std::size_t tile) const {
    return {.tracer = &tracer, .stored = nullptr, .view = &view, .hits = &hits[tile], .first_row = first_row};
  }
};

}  // namespace gnomon::raytrace
