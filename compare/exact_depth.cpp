#include "compare/exact_depth.h"

#include "compare/biased_test.h"
#include "compare/columns.h"
#include "compare/stored_surface.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

// Infinite where the ray meets nothing.
std::optional<double> depth_of_stored(const LadderInput& in, raytrace::TexelKey key, double first_depth) {
  if (raster::traits_of(in.drawn.options.map.technique).contents == raster::MapContents::midpoint_depth)
    return std::nullopt;
  if (in.drawn.options.map.cull == raster::Cull::none) return first_depth;
  const StoredSurface stored = stored_surface(in, key);
  if (stored.primitive == no_id) return std::nullopt;
  return stored.depth;
}

std::optional<BiasedLookup> lookup_of(const LadderInput& in, std::size_t pixel) {
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const Vec3 to_light = light_at(in.light, receiver.position).to_light;
  return biased_lookup(in.record, in.drawn.options.map.bias, to_light, receiver, pixel);
}

// Up to the rounding of doubles the receiver itself counts as level with what it is compared with, as in V3.
double gap_before_exact(const LadderInput& in, const BiasedLookup& lookup,
                        const raytrace::SurfacePoint& receiver, double depth) {
  const raytrace::TexelKey key = lookup.key;
  const Ray ray = caster_ray(in.record.map.view, key.face(), key.column() + 0.5, key.row() + 0.5);
  return gap_before(in.record, in.drawn.options.map.bias, receiver.normal, lookup, depth) -
         plane_rounding(ray, receiver);
}

}  // namespace

double gap_with_bias(const LowerClimb& lower, const LadderInput& in, std::size_t group, std::size_t pixel,
                     raytrace::TexelKey& texel) {
  const auto lookup = lookup_of(in, pixel);
  if (!lookup) return -infinity;
  texel = lookup->key;
  const auto depth = stored_caster(in.record, texel);
  if (!depth) return -infinity;
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const double exact = lower.centres[group];
  if (texel == lower.groups.keys[group] && is_exact(in, *depth, exact))
    return gap_before_exact(in, *lookup, receiver, exact);
  return gap_before(in.record, in.drawn.options.map.bias, receiver.normal, *lookup, *depth);
}

std::optional<double> exact_gap(const LowerClimb& lower, const LadderInput& in, std::size_t group,
                                std::size_t pixel) {
  const auto lookup = lookup_of(in, pixel);
  if (!lookup) return std::nullopt;
  double first_depth = lower.centres[group];
  if (lookup->key != lower.groups.keys[group]) first_depth = trace_centre(in, lookup->key).depth;
  const auto depth = depth_of_stored(in, lookup->key, first_depth);
  if (!depth) return std::nullopt;
  if (std::isinf(*depth)) return -infinity;
  return gap_before_exact(in, *lookup, in.traced.receiver.data[pixel], *depth);
}

}  // namespace gnomon::compare
