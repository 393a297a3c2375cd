// What belongs to a texel rather than to a pixel: the exact ray through its centre, and the sheets in its
// column.
#pragma once

#include <optional>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/truth/surfaces.h"
#include "raytrace/sheets/column_sheets.h"

namespace gnomon::compare {

/// The first thing that the exact light ray through a texel's centre meets.
struct TexelCentre {
  int face = 0;
  Ray ray;
  std::optional<raytrace::Hit> hit;
  double depth = infinity;  ///< of the hit, along the map's forward axis
};

/// texel_ray(), but that of an orthographic map starts well before all casters, where its interval begins: no t is
/// negative then, as single rays are traced fastest. They lie behind the near depth, unless that was given.
Ray caster_ray(const World& world, const LightView& view, int face, double u, double v);
/// The hits along a ray, nearest first, of which closest(ray) finds one, until visit(hit) is false. There are no more
/// than 64, for what is looked for is among the first few or not at all. Exact arithmetic compares a hit's exact place
/// with where the ray starts, and its t is rounded. So a ray that starts just behind it may meet it again; it then
/// starts farther on, by steps that double.
template <class Closest, class Visit>
void visit_hits(Ray ray, const Closest& closest, const Visit& visit) {
  constexpr int most_hits = 64;
  std::uint32_t last = no_id;
  double step = 0.0;
  for (int count = 0; count < most_hits;) {
    const std::optional<raytrace::Hit> hit = closest(ray);
    if (!hit) return;
    if (hit->primitive == last && !(hit->t > ray.t.min)) {
      ray.t.min += step, step *= 2.0;
      continue;
    }
    if (!visit(*hit)) return;
    ray.t.min = std::nextafter(hit->t, infinity);
    ++count, last = hit->primitive, step = ray.t.min - hit->t;
  }
}
/// The first hit along a ray, before t_end, that `wanted` holds of.
template <class Wanted>
std::optional<raytrace::Hit> first_on_ray(const raytrace::Tracer& tracer, const Ray& ray, double t_end,
                                          const Wanted& wanted) {
  std::optional<raytrace::Hit> found;
  visit_hits(
      ray, [&](const Ray& from) { return tracer.closest_hit(from, raytrace::Sides::casting); },
      [&](const raytrace::Hit& hit) {
        if (!(hit.t < t_end)) return false;
        if (wanted(hit)) found = hit;
        return !found.has_value();
      });
  return found;
}

/// Traces the centre of texel (column, row) of a face, in any map of the light's.
TexelCentre trace_centre(const raytrace::Tracer& tracer, const LightView& view, int face, int column,
                         int row);
TexelCentre trace_centre(const LadderInput& input, raytrace::TexelKey key);
std::vector<TexelCentre> trace_centres(const LadderInput& input, const std::vector<raytrace::TexelKey>& keys);

/// Rounding of a plane-ray intersection: the terms of t = n.(x - o) / n.d, each with a few units in the last
/// place.
double plane_rounding(const Ray& ray, const raytrace::SurfacePoint& receiver);
/// The centre's ray meets nothing, or nothing before the receiver's tangent plane.
bool meets_plane_unhindered(const LadderInput& input, const TexelCentre& centre,
                            const raytrace::SurfacePoint& receiver);

/// One texel's sheets, found as they are asked for: by one thread.
class Column {
 public:
  Column(const LadderInput& input, raytrace::TexelKey key, const Surfaces& surfaces)
      : input_(input), key_(key), surfaces_(surfaces) {}
  raytrace::TexelKey key() const { return key_; }
  /// Whether two primitives, both met by light rays on the side that faces the light, hang together in this
  /// column. Asked of several b, a is best the same one.
  bool same_sheet(std::uint32_t a, std::uint32_t b);
  /// Which primitives hang together at all, in any column.
  const Surfaces& surfaces() const { return surfaces_; }

 private:
  const LadderInput& input_;
  raytrace::TexelKey key_;
  const Surfaces& surfaces_;
  std::optional<raytrace::ColumnSheets> sheets_;
};

}  // namespace gnomon::compare
