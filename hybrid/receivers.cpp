#include "hybrid/receivers.h"

#include <numeric>

#include "raytrace/packet/passes.h"
#include "raytrace/tiles.h"

namespace gnomon::hybrid {

using raytrace::SurfacePoint;

ReceiverFinder::ReceiverFinder(const raytrace::Tracer& tracer) : tracer_(tracer) {
  const raytrace::Structures& s = tracer.structures();
  leaf_of_.assign(tracer.world().primitive_count(), raytrace::nothing_hit);
  for (std::uint32_t i = 0; i < s.bvh.ids.size(); ++i) leaf_of_[s.bvh.ids[i]] = i;
  for (std::uint32_t i = 0; i < s.planes.size(); ++i) leaf_of_[s.planes[i]] = raytrace::first_plane + i;
}

ReceiverCounts ReceiverFinder::find(const View& view, const Image<std::uint32_t>& primitive,
                                    Image<SurfacePoint>& receivers) const {
  if (!(receivers.size == primitive.size)) receivers = Image<SurfacePoint>(primitive.size);
  const raytrace::TileGrid grid{primitive.size};
  std::vector<std::uint64_t> traced(grid.count());
  for_each_tile(grid, [&](std::size_t tile, int x0, int y0, int x1, int y1) {
    traced[tile] = raytrace::known_tile(tracer_, view, leaf_of_, {x0, y0, x1, y1}, primitive, receivers);
  });
  return {std::accumulate(traced.begin(), traced.end(), std::uint64_t{0})};
}

}  // namespace gnomon::hybrid
