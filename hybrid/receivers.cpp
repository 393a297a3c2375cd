#include "hybrid/receivers.h"

#include <numeric>

#include "raytrace/packets/passes.h"
#include "raytrace/tiles.h"

namespace gnomon::hybrid {

using raytrace::SurfacePoint;

ReceiverFinder::ReceiverFinder(const raytrace::Tracer& tracer)
    : tracer_(tracer), leaf_of_(raytrace::hit_places(tracer)) {}

Receivers make_receivers(Image<SurfacePoint> points) {
  Receivers made{std::move(points), {}};
  const raytrace::TileGrid grid{made.points.size};
  made.tiles = raytrace::HugeArray<raytrace::QuantisedTile>(grid.count());
  for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    raytrace::QuantisedTile& tile = made.tiles[i];
    raytrace::TileDraft draft;
    tile.clear();
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        tile.put(raytrace::tile_lane(x - x0, y - y0), made.points.at(x, y), draft);
    tile.finish(draft, draft.bounds.center());  // exact: no error grows with a distance
    raytrace::publish_receivers();
  });
  return made;
}

ReceiverCounts ReceiverFinder::find(const View& view, int first_row, const Image<std::uint32_t>& primitive,
                                    Receivers& receivers) const {
  const raytrace::TileGrid grid{primitive.size};
  if (!(receivers.points.size == primitive.size)) {
    receivers.points = Image<SurfacePoint>(primitive.size);
    receivers.tiles = raytrace::HugeArray<raytrace::QuantisedTile>(grid.count());
  }
  std::vector<std::uint64_t> traced(grid.count());
  for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
    traced[i] = raytrace::known_tile(tracer_, view, first_row, leaf_of_, {x0, y0, x1, y1}, primitive,
                                     receivers.points, receivers.tiles[i]);
    raytrace::publish_receivers();
  });
  return {std::accumulate(traced.begin(), traced.end(), std::uint64_t{0})};
}

}  // namespace gnomon::hybrid
