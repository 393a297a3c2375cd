#include "compare/bias/derived_bias.h"

#include <algorithm>
#include <cmath>

namespace gnomon::compare {
namespace {

using raster::Technique;

/// Along one axis; none: see derive_bias.
std::optional<double> reach_of(const raster::MapOptions& map, const raster::LightRecord& record) {
  constexpr double own_texel = 0.5, two_by_two = 1.0;
  const double radius = map.filter.radius_texels;
  if (record.captured && record.captured->test &&
      record.captured->test->read == raster::CapturedTest::Read::linear_depths)
    return two_by_two;
  switch (map.technique) {
    case Technique::hard:
    case Technique::csm:
    case Technique::cube:
      return own_texel;
    case Technique::pcf:
      break;
    default:
      return std::nullopt;
  }
  if (record.captured) return std::max(own_texel, radius);
  switch (map.filter.kernel) {
    case raster::FilterKernel::hardware:
      return two_by_two;
    case raster::FilterKernel::box:
      return std::floor(radius) + own_texel;
    default:
      return radius + own_texel;
  }
}

/// The constant that was drawn with on a face, world units: of another renderer's test it is one stored number for all.
double drawn_constant(const raster::LightRecord& record, int face, const BiasLayer& layer) {
  const double constant = record.bias_constant_world + record.caster_constant_world;
  if (record.captured && record.captured->test) {
    const raster::CapturedTest& test = *record.captured->test;
    const double beside = test.layers.empty() ? 0.0 : test.layers[static_cast<std::size_t>(face)].constant;
    return (constant / test.unit_world + beside) / layer.stored_per_world;
  }
  const double base = record.rounding.constant_texel_world;
  return base > 0.0 ? constant * layer.texel_world / base : constant;
}

}  // namespace

double stored_per_world(const raster::LightRecord& record, int face, const World& world) {
  const LightView& view = record.map.view;
  const LightFace& f = view.face(face);
  const double range = f.far_depth - f.near_depth;
  const bool parallel = view.projection == LightProjection::orthographic;
  if (record.captured && record.captured->test) {
    const raster::CapturedTest& test = *record.captured->test;
    if (!parallel || test.stores != raster::CapturedTest::Stores::depths) return 1.0 / test.unit_world;
  }
  if (parallel) return 1.0 / range;
  double z = 0.0;
  if (!world.finite_bounds.empty()) z = project_to_texel(view, world.finite_bounds.center()).depth;
  const double product = f.near_depth * f.far_depth;
  return product / ((z > 0.0 ? z * z : std::max(0.0, product)) * range);
}

std::optional<DerivedBias> derive_bias(const raster::MapOptions& map, const raster::LightRecord& record,
                                       const World& world) {
  const auto reach = reach_of(map, record);
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
    layer.drawn_world = drawn_constant(record, face, layer);
    out.layers.push_back(layer);
  }
  const double rounding = raster::rounding_world(record.rounding, view, world);
  out.constant_texels = raster::automatic_bias_texels * out.slope + rounding / narrowest;
  for (BiasLayer& layer : out.layers) layer.derived_world = out.constant_texels * layer.texel_world;
  return out;
}

}  // namespace gnomon::compare
