// What belongs to a texel rather than to a pixel: the exact ray through its centre, and the sheets in its
// column. Sheets are found only for columns where a decision hangs on them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "compare/ladder.h"
#include "compare/surfaces.h"

namespace gnomon::compare {

/// The first thing that the exact light ray through a texel's centre meets.
struct TexelCentre {
  int face = 0;
  Ray ray;
  std::optional<raytrace::Hit> hit;
  double depth = infinity;  ///< of the hit, along the map's forward axis
};

/// texel_ray(), but that of an orthographic map starts well before the near depth, which lies before all
/// casters and is where its interval begins: no t is negative then, as single rays are traced fastest.
Ray caster_ray(const LightView& view, int face, double u, double v);
/// The hits along a ray, nearest first, of which closest(ray) finds one; until visit(hit) is false, and no more than 64,
/// for what is looked for is among the first few or not at all. Exact arithmetic compares a hit's exact place with where
/// the ray starts, and its t is rounded: a ray that starts just behind it may meet it again, and then starts farther on,
/// by steps that double.
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
      ray, [&](const Ray& from) { return tracer.closest_hit(from); },
      [&](const raytrace::Hit& hit) {
        if (!(hit.t < t_end)) return false;
        if (wanted(hit)) found = hit;
        return !found.has_value();
      });
  return found;
}

TexelCentre trace_centre(const LadderInput& input, raytrace::TexelKey key);
std::vector<TexelCentre> trace_centres(const LadderInput& input, const std::vector<raytrace::TexelKey>& keys);

/// Rounding of a plane-ray intersection: the terms of t = n.(x - o) / n.d, each with a few units in the last
/// place.
double plane_rounding(const Ray& ray, const raytrace::SurfacePoint& receiver);
/// The centre's ray meets nothing, or nothing before the receiver's tangent plane.
bool meets_plane_unhindered(const LadderInput& input, const TexelCentre& centre,
                            const raytrace::SurfacePoint& receiver);

/// One texel's sheets; empty when none of its pixels needs them.
class Column {
 public:
  Column() = default;
  using Sheets = std::shared_ptr<const std::vector<raytrace::Sheet>>;
  Column(const LadderInput& input, raytrace::TexelKey key, Sheets sheets, const Surfaces& surfaces)
      : input_(&input), key_(key), sheets_(std::move(sheets)), surfaces_(&surfaces) {}
  raytrace::TexelKey key() const { return key_; }
  /// Whether two primitives, both met by light rays on the side that faces the light, hang together in this
  /// column.
  bool same_sheet(std::uint32_t a, std::uint32_t b) const;
  /// Which primitives hang together at all, in any column.
  const Surfaces& surfaces() const { return *surfaces_; }

 private:
  bool faces_light(std::uint32_t primitive) const;
  const LadderInput* input_ = nullptr;
  raytrace::TexelKey key_;
  Sheets sheets_;
  const Surfaces* surfaces_ = nullptr;
};

/// Triangle lists for the groups that need sheets; the sheets themselves are found on demand, per column.
class ColumnSet {
 public:
  /// Lists for the groups whose lower rungs hang on sheets. `input` and `groups` must outlive this.
  ColumnSet(const LadderInput& input, const TexelGroups& groups, const std::vector<TexelCentre>& centres);
  /// Lists for the marked groups too, where they have none yet. Not to be called while others read.
  void add(const std::vector<char>& marked_groups);
  /// Empty for a group that was never marked.
  Column column(std::size_t group) const;
  /// The same, kept for the next frame that looks at it; by one thread at a time for each group.
  Column kept_column(std::size_t group);

 private:
  Column::Sheets find(std::size_t group) const;
  const LadderInput& input_;
  const TexelGroups& groups_;
  std::vector<raytrace::TexelLists> lists_;
  std::vector<std::uint32_t> batch_of_group_;  ///< index in lists_, or no_id
  std::vector<Column::Sheets> kept_;           ///< by group; null: not asked for yet
  Surfaces surfaces_;
};

}  // namespace gnomon::compare
