#include "compare/truth/stored_surface.h"

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/truth/columns.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

/// What rounding may have done to a stored depth, as a depth along forward.
double rounding_at(const raster::LightRecord& record, raytrace::TexelKey key) {
  const double stored = record.map.true_depth()[record.map.texel_index(key.face(), key.column(), key.row())];
  const auto depth_at = [&](double s) {
    return depth_from_stored(record.map.view, key.face(), key.row() + 0.5, s);
  };
  return record.rounding.float_world +
         std::abs(depth_at(stored + record.rounding.stored_step) - depth_at(stored));
}

raytrace::Sides sides_left(const raster::LightRecord& record, raster::Cull cull) {
  if (record.foreign || cull == raster::Cull::none) return raytrace::Sides::both;
  return cull == raster::Cull::front ? raytrace::Sides::backs : raytrace::Sides::fronts;
}

/// A shape's two sides have one number, and the tracer meets both.
bool is_left(const raytrace::Tracer& tracer, const Ray& ray, const raytrace::Hit& hit,
             raytrace::Sides sides) {
  const World& world = tracer.world();
  if (sides == raytrace::Sides::both || world.is_triangle(hit.primitive)) return true;
  const Vec3 outwards = geometric_normal(world, hit.primitive, ray.at(hit.t));
  return (glm::dot(outwards, ray.direction) > 0.0) == (sides == raytrace::Sides::backs);
}

}  // namespace

StoredSurface stored_surface(const raytrace::Tracer& tracer, const raster::LightRecord& record,
                             const raster::MapOptions& options, raytrace::TexelKey key) {
  const auto wanted = unbiased_caster(record, key);
  if (!wanted) return {};
  const LightView& view = record.map.view;
  const bool takes_first =
      raster::traits_of(options.technique).contents == raster::MapContents::midpoint_depth;
  const double slack = takes_first ? infinity : rounding_at(record, key);
  const raytrace::Sides sides = sides_left(record, options.cull);
  const Ray ray = caster_ray(tracer.world(), view, key.face(), key.column() + 0.5, key.row() + 0.5);
  StoredSurface best;
  double nearest = infinity;
  visit_hits(
      // As casters are found: both sides of single-sided materials cast shadows, and a map may hold their backs.
      ray, [&](const Ray& from) { return tracer.closest_hit(from, sides); },
      [&](const raytrace::Hit& hit) {
        if (!is_left(tracer, ray, hit, sides)) return true;
        const double depth = glm::dot(ray.at(hit.t) - view.origin, view.face(key.face()).forward);
        const double off = std::abs(depth - *wanted);
        if (off < nearest) best = {hit.primitive, hit.t, depth}, nearest = off;
        return off > slack && depth < *wanted;
      });
  return best;
}

}  // namespace gnomon::compare
