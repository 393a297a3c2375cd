#include "hybrid/light_sheets.h"

#include "raytrace/precision/error_bounds.h"
#include "scene/base/parallel.h"
#include "scene/base/timing.h"

namespace gnomon::hybrid {
namespace {

constexpr std::uint64_t parts_per_tile = std::uint64_t{tile_texels} * tile_texels * parts_per_texel;

std::vector<ProjectedPoint> project(const World& world, const SheetGrid& grid, int face) {
  constexpr std::size_t grain = 4096;  // vertices per task
  std::vector<ProjectedPoint> points(world.vertex_count());
  parallel_for(points.size(), grain, [&](std::size_t i) {
    points[i] = grid.point(face, world.position(static_cast<std::uint32_t>(i)));
  });
  return points;
}

}  // namespace

LightSheets::LightSheets(const World& world, const raytrace::Topology& topology, const LightView& view)
    : world_(world), topology_(topology), grid_(world, view) {
  if (!grid_.hopeless) lone_plane_ = find_lone_plane();
}

void LightSheets::build() {
  const Stopwatch watch;
  const auto tile_count = static_cast<std::size_t>(grid_.tiles) * static_cast<std::size_t>(grid_.tiles) *
                          static_cast<std::size_t>(grid_.view.face_count);
  tiles_.resize(tile_count);
  if (grid_.hopeless) {
    for (SheetTile& tile : tiles_) tile.uniform = pack(ambiguous_texel);
  } else {
    facing_ = find_facing(world_, topology_, grid_.view, grid_.bounds);
    for (int face = 0; face < grid_.view.face_count; ++face) build_face(face);
  }
  count_tiles();
  stats_.build_ms = watch.elapsed_ms();
}

void LightSheets::build_face(int face) {
  std::vector<ProjectedPoint> points = project(world_, grid_, face);
  TileBins bins(world_, grid_, points);
  faces_.push_back({std::move(points), std::move(bins)});
  const Face& made = faces_.back();
  PerThread<TileBuilder> builders(
      [&] { return TileBuilder(world_, topology_, grid_, facing_, face, made.points, *store_); });
  parallel_for(grid_.tiles * grid_.tiles, [&](int i) {
    const int x = i % grid_.tiles, y = i / grid_.tiles;
    tiles_[grid_.tile_index(face, x, y)] =
        builders.local().build(x, y, made.bins.triangles(static_cast<std::size_t>(i)));
  });
  for (const TileBuilder& builder : builders) stats_.pieces += builder.pieces();
}

void LightSheets::count_tiles() {
  stats_.bytes = tiles_.size() * sizeof(SheetTile) + facing_.size() * sizeof(TriangleFacing);
  for (const Face& face : faces_)
    stats_.bytes += face.points.size() * sizeof(ProjectedPoint) + face.bins.bytes();
  stats_.detailed_tiles = 0;
  texels_.clear();
  for (const SheetTile& tile : tiles_) {
    texels_.push_back(tile.texels);
    stats_.detailed_tiles += tile.texels ? 1 : 0;
    stats_.bytes += tile.bytes();
  }
}

std::optional<std::uint64_t> LightSheets::part_of(const Vec3& position) const {
  const auto at = place_of(position);
  const double size = grid_.view.size;
  if (!at || !(at->u >= 0.0 && at->v >= 0.0 && at->u < size && at->v < size)) return std::nullopt;
  const int x = static_cast<int>(at->u), y = static_cast<int>(at->v);
  const auto texel = static_cast<std::uint32_t>(y % tile_texels * tile_texels + x % tile_texels);
  return grid_.tile_index(at->face, x / tile_texels, y / tile_texels) * parts_per_tile +
         SheetTile::part_at(texel, at->u - x, at->v - y);
}

std::size_t LightSheets::refine(std::vector<std::uint64_t> parts) {
  if (faces_.empty()) return 0;
  const Stopwatch watch;
  const auto in_tile = [](std::uint64_t part) { return static_cast<std::uint32_t>(part % parts_per_tile); };
  std::erase_if(parts, [&](std::uint64_t p) { return tiles_[p / parts_per_tile].is_known(in_tile(p)); });
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  std::vector<std::size_t> first;  // of each tile's parts
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (i == 0 || parts[i] / parts_per_tile != parts[i - 1] / parts_per_tile) first.push_back(i);
  first.push_back(parts.size());
  const auto per_face = static_cast<std::size_t>(grid_.tiles) * static_cast<std::size_t>(grid_.tiles);
  parallel_for(first.size() - 1, [&](std::size_t k) {
    const std::size_t tile = parts[first[k]] / parts_per_tile, on_face = tile % per_face;
    std::vector<std::uint32_t> asked;
    for (std::size_t i = first[k]; i < first[k + 1]; ++i) asked.push_back(in_tile(parts[i]));
    const Face& face = faces_[tile / per_face];
    TileBuilder builder(world_, topology_, grid_, facing_, static_cast<int>(tile / per_face), face.points,
                        *store_);
    builder.refine(static_cast<int>(on_face) % grid_.tiles, static_cast<int>(on_face) / grid_.tiles,
                   face.bins.triangles(on_face), asked, tiles_[tile]);
  });
  count_tiles();
  stats_.refine_ms += watch.elapsed_ms();
  return parts.size();
}

// Light rays beside an orthographic map meet planes only, if everything finite lies on the map. Perspective
// maps show all that their light reaches.
std::uint32_t LightSheets::find_lone_plane() const {
  const World& world = world_;
  if (grid_.perspective) return no_id;
  std::uint32_t plane = no_id;
  // Around p, so many world units along u and v.
  const auto on_map = [&](const Vec3& p, double along_u, double along_v) {
    const ProjectedPoint at = grid_.point(0, p);
    const double u = along_u * glm::length(grid_.faces[0].u) - texel_slack;
    const double v = along_v * glm::length(grid_.faces[0].v) - texel_slack;
    return at.u >= u && at.v >= v && at.u <= grid_.view.size - u && at.v <= grid_.view.size - v;
  };
  const Vec3 along_u = glm::normalize(grid_.faces[0].u), along_v = glm::normalize(grid_.faces[0].v);
  for (std::uint32_t id = world.triangle_count(); id < world.primitive_count(); ++id) {
    const auto& geometry = world.shape(id).geometry;
    if (std::holds_alternative<Plane>(geometry)) {
      if (plane != no_id) return no_id;
      plane = id;
      continue;
    }
    const auto* sphere = std::get_if<Sphere>(&geometry);
    const bool is_on_map = sphere != nullptr ? on_map(sphere->center, sphere->radius, sphere->radius)
                                             : on_map(solid_center(geometry), reach_along(geometry, along_u),
                                                      reach_along(geometry, along_v));
    if (!is_on_map) return no_id;
  }
  if (plane == no_id) return no_id;
  const auto box_is_on_map = [&](const Aabb& box) {  // then so is all within it: the map is convex
    for (int i = 0; i < 8; ++i)
      if (!on_map({(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                   (i & 4) != 0 ? box.max.z : box.min.z},
                  0.0, 0.0))
        return false;
    return true;
  };
  for (const WorldPart& part : world.parts) {
    if (box_is_on_map(part.bounds)) continue;
    for (std::uint32_t t = 0; t < part.triangle_count(); ++t)
      for (const Vec3& corner : part.corners(t))
        if (!on_map(corner, 0.0, 0.0)) return no_id;
  }
  return plane;
}

}  // namespace gnomon::hybrid
