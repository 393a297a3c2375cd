// Rays against the world: the reference that the rasterizer is measured by. Double precision (unless asked
// for less), watertight triangles, closed-form shapes, alpha-masked hits honoured. Ties in t go to the lowest
// primitive id. A ray's hits count for t in the open interval (t.min, t.max): a surface exactly at an end is
// not hit. NaN, infinite and zero-direction rays hit nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "scene/base/timing.h"
#include "scene/light.h"
#include "scene/math.h"
#include "scene/world.h"

namespace gnomon::raytrace {

struct Structures;
struct WideLeaf;
struct WideInstance;

struct Hit {
  double t = 0.0;
  std::uint32_t primitive = no_id;
  Vec2 barycentric{0.0};  ///< weights of the triangle's second and third corner; 0 for shapes
};

/// A point on a surface with a bound on how far rounding may have moved it.
struct alignas(32) SurfacePoint {
  Vec3 position;
  Vec3 position_error;  ///< componentwise bound, world units (Pharr et al., PBR 4th ed., section 6.8)
  Vec3 normal;          ///< geometric, unit, on the side the ray came from
  std::uint32_t primitive = no_id;
  Vec2 barycentric{0.0};
};

/// Which structure finds the primitives; all give the same answers. bvh is the fastest on most scenes;
/// bvh_median, kdtree_cyclic and grid_textbook are the textbooks' plain versions (raytrace/accel/);
/// two_level stores a mesh's tree once for all its instances.
enum class Accel : std::uint8_t {
  bvh,
  bvh_median,
  kdtree,
  kdtree_cyclic,
  octree,
  grid,
  grid_textbook,
  bsp,
  two_level,
  brute
};

std::string_view accel_name(Accel accel);
std::span<const Accel> all_accels();

/// The arithmetic of the rays. fast: floats, as textbooks have it, wrong where HARD_CASES says. robust:
/// doubles, watertight, with error bounds that make ambiguity visible. exact: robust, what is ambiguous decided by exact
/// predicates.
enum class Precision : std::uint8_t { fast, robust, exact };
std::string_view precision_name(Precision precision);

/// What a ray meets on its way to a light. `uncertain`: within the computation's own error bound of either
/// answer.
enum class PointVisibility : std::uint8_t { shadowed = 0, lit = 1, uncertain = 2 };

/// Says which sides of triangles are met; shapes are met on both. seen: both, but for backs of single-sided materials
/// (scene/scene.h, shows_back). casting: both, of what casts shadows; fronts and backs of that: as the mesh has them, of
/// mirrored instances too.
enum class Sides : std::uint8_t { both, seen, casting, fronts, backs };

struct AccelStats {
  double build_ms = 0.0;
  std::uint64_t bytes = 0;
  std::uint64_t nodes = 0;
  std::uint64_t dropped = 0;  ///< primitives that cannot be hit: not finite, or without area
};

/// What a query cost, machine-independent. Queries that count are slower; the plain ones do not count.
struct WorkCounts {
  std::uint64_t boxes = 0;  ///< tested; of a node of the default hierarchy all four places, empty ones too
  std::uint64_t primitives = 0;  ///< tested: triangles and shapes, infinite planes among them
};

/// The leaf that blocked the last shadow ray. It is tried first, for it often blocks the next ray, too (Pearce and Jevans 1991,
/// "Exploiting shadow coherence in ray tracing"), and changes no answer. For the rays of one tracer.
struct LastBlocker {
  const WideLeaf* leaf = nullptr;          ///< null: none yet
  const WideInstance* instance = nullptr;  ///< of which the leaf is; null: of none
};

class Tracer {
 public:
  /// The world must outlive the tracer.
  Tracer(const World& world, Accel accel, Precision precision = Precision::robust);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  std::optional<Hit> closest_hit(const Ray& ray) const;
  /// The closest hit, but for triangles that are met on another side.
  std::optional<Hit> closest_hit(const Ray& ray, Sides sides) const;
  bool occluded(const Ray& ray) const;
  /// What the eye, or a mirrored, refracted or gathered ray sees: the closest hit, but for backs of single-sided
  /// materials (scene/scene.h, shows_back), which hide nothing. Shadows are cast from both sides: occluded().
  std::optional<Hit> closest_seen(const Ray& ray) const;
  /// Adds what the search costs to `work`.
  std::optional<Hit> closest_hit(const Ray& ray, WorkCounts& work) const;
  std::optional<Hit> closest_seen(const Ray& ray, WorkCounts& work) const;
  bool occluded(const Ray& ray, WorkCounts& work) const;

  /// The surface point of a hit of this ray, with its error bound.
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const;

  /// The one ray-offset policy (raytrace/precision/ray_offset.h): a ray that leaves a surface point on the
  /// side of `direction`. It is moved off the surface by the point's error bound, so that it cannot meet the
  /// surface it starts on.
  Ray spawn_ray(const SurfacePoint& from, const Vec3& direction) const;

  /// From the point to the light's centre: unit direction, t is distance and ends strictly before the light
  /// by the error bound of the distance; unbounded for directional lights. The origin is moved off the
  /// surface as by spawn_ray.
  Ray shadow_ray(const SurfacePoint& from, const Light& light) const;

  /// Returns the ray to any point, such as one of a light with size.
  Ray shadow_ray(const SurfacePoint& from, const Vec3& target) const;

  /// Whether anything can shadow the point: its material receives shadows.
  bool receives_shadow(const SurfacePoint& point) const;

  /// Exact visibility of the light's centre, with the error bound's ambiguity made visible. Any unmasked surface
  /// that casts shadows occludes, glass too, but what receives none is lit. The point's own triangle or plane never does; its own sphere only when seen from
  /// within. `last`: null, or what is kept from one ray for the next one.
  PointVisibility centre_visibility(const SurfacePoint& from, const Light& light,
                                    LastBlocker* last = nullptr) const;
  /// Returns the closest hit when every triangle or sphere that the ray does not surely miss is one of these positions in
  /// leaf order (Structures::bvh); not for Precision::fast.
  std::optional<Hit> closest_seen_among(const Ray& ray, std::span<const std::uint32_t> leaves) const;
  /// occluded() where all but planes that the ray may intersect is among these.
  bool occluded_among(const Ray& ray, std::span<const std::uint32_t> leaves) const;
  PointVisibility centre_visibility_among(const SurfacePoint& from, const Light& light,
                                          std::span<const std::uint32_t> leaves) const;

  /// The occluder nearest to the point on the way to the light, if any; own triangle and plane left out.
  std::optional<Hit> nearest_occluder(const SurfacePoint& from, const Light& light) const;

  const World& world() const;
  Precision precision() const;
  Accel accel() const;
  const AccelStats& stats() const;
  /// For this room's own algorithms (visibility): raytrace/kernels.h.
  const Structures& structures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What many single rays are answered by (raytrace/bvh/wide_tree.h), for those who measure it.

/// Makes it now; else it is made when enough rays have come. Accel::bvh alone has it. Any number of threads may
/// ask, and cast rays meanwhile.
void prepare_single_rays(const Tracer& tracer);

/// Bytes that it holds; 0: it has not been made.
std::uint64_t single_ray_bytes(const Tracer& tracer);

/// What making all that the tracer has by now took, as often as passes are timed (times_again): what casters that move make
/// anew, since nothing is refitted. The structure is made again beside the tracer's own, so one that takes long is made but
/// once, whatever `most` runs are asked for.
Times time_structure(const Tracer& tracer, int most);

/// Do what Tracer::closest_hit() and occluded() with counts do, but through what single rays go through when it has been
/// made. That is boxes of children and triangles of leaves tested in floats, and planes.
std::optional<Hit> counted_closest_hit(const Tracer& tracer, const Ray& ray, WorkCounts& work);
bool counted_occluded(const Tracer& tracer, const Ray& ray, WorkCounts& work);

}  // namespace gnomon::raytrace
