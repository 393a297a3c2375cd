#include "compare/bias/derived_bias.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"

namespace gnomon::compare {
double stored_per_world(const raster::LightRecord& record, int face, const World& world) {
  const LightView& view = record.map.view;
  const LightFace& f = view.face(face);
  const double range = f.far_depth - f.near_depth;
  const bool parallel = view.projection == LightProjection::orthographic;
  if (const auto even = test_of(record).stored_per_world(view)) return *even;
  if (parallel) return 1.0 / range;
  double z = 0.0;
  if (!world.finite_bounds.empty()) z = project_to_texel(view, world.finite_bounds.center()).depth;
  const double product = f.near_depth * f.far_depth;
  return product / ((z > 0.0 ? z * z : std::max(0.0, product)) * range);
}

std::optional<DerivedBias> derive_bias(const raster::MapOptions& map, const raster::LightRecord& record,
                                       const World& world) {
  if (!record.has_known_map()) return std::nullopt;
  const auto reach = test_of(record).reach_texels(map);
  if (!reach) return std::nullopt;
  const LightView& view = record.map.view;
  const bool parallel = view.projection == LightProjection::orthographic;
  DerivedBias out{
      .reach_texels = *reach, .slope = 2.0 * *reach, .normal_offset_texels = std::sqrt(2.0) * *reach};
  double narrowest = infinity;
  for (int face = 0; face < (parallel ? view.face_count : 1); ++face) {
    const double texel = parallel ? texel_world_size(view, face, 1.0) : record.texel_world;
    narrowest = std::min(narrowest, texel);
    BiasLayer layer{texel, stored_per_world(record, face, world)};
    layer.drawn_world =
        test_of(record).constant_world(record, face, layer.texel_world, layer.stored_per_world);
    out.layers.push_back(layer);
  }
  const double rounding = raster::rounding_world(record.rounding, view, world);
  out.constant_texels = raster::automatic_bias_texels * out.slope + rounding / narrowest;
  for (BiasLayer& layer : out.layers) layer.derived_world = out.constant_texels * layer.texel_world;
  return out;
}

}  // namespace gnomon::compare
