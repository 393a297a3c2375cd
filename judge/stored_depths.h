// How precise a captured map's numbers are, and whether one of them is the depth of what the light meets first at its texel.
#pragma once

#include <optional>
#include <vector>

#include "compare/truth/columns.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

/// A surface on the ray through a place of the map.
struct SurfaceOnRay {
  std::uint32_t primitive = no_id;
  double depth = infinity;    ///< along the map's forward axis
  double across = 0.0;        ///< what its depth changes by over half a texel along both axes, added up
  double stored_slope = 0.0;  ///< stored numbers from texel to texel, along the axis where it changes more
  bool front = true;          ///< its front faces the light
  double cosine = 1.0;        ///< of the angle between its normal and the way to the light
};

/// Texels of a face in even steps, 192 or a few more on each side; all of a small one.
std::vector<raytrace::TexelKey> sampled_texels(const LightView& view, int face);

class StoredDepths {
 public:
  StoredDepths(const FrameInput& input, const raster::LightRecord& record);

  /// By how much stored numbers differ at least at this depth in the map's format.
  double step(raytrace::TexelKey key, double depth) const;
  /// What the texel stores, without the casters' bias once that was taken out.
  double stored(raytrace::TexelKey key) const;
  bool is_empty(raytrace::TexelKey key) const { return !holds_caster(view_, stored(key)); }
  /// As is_empty(); where the texel stores averages: whether nothing may be drawn in the texel itself.
  bool may_be_empty(raytrace::TexelKey key) const;
  /// The stored number as a depth along the map's forward axis.
  double depth(raytrace::TexelKey key) const;

  /// The ray of what a texel holds, or so many texels beside its middle. Where the record's map is none of the renderer's own: of the texel that has its middle.
  Ray ray(raytrace::TexelKey key, const Vec2& off = Vec2(0.0)) const;
  /// What the light meets first on that ray.
  std::optional<SurfaceOnRay> first(raytrace::TexelKey key, const Vec2& off = Vec2(0.0)) const;
  /// All that it meets there, nearest first, at most so many.
  std::vector<SurfaceOnRay> all(raytrace::TexelKey key, std::size_t most = 12) const;
  /// The same in a scene with other materials.
  std::vector<SurfaceOnRay> all(const raytrace::Tracer& tracer, raytrace::TexelKey key,
                                std::size_t most = 12) const;

  /// Whether the stored number is this depth, but for `slack` (a depth), a step of the format and 2^-22 of
  /// arithmetic. A depth before the near plane or behind the far one counts as one on it.
  bool is_stored(raytrace::TexelKey key, double depth, double slack) const;
  /// Whether the map holds the first surface of the texel's centre, or of a place within 1/8 texel of it.
  bool holds_scene(raytrace::TexelKey key) const;
  /// Tells whether the map holds a neighbour's depth within one texel.
  bool holds_neighbours(raytrace::TexelKey key) const;

 private:
  bool stores_averages() const;
  bool holds_within(raytrace::TexelKey key, double reach, int steps, double slope_texels) const;
  SurfaceOnRay surface(const Ray& ray, const raytrace::Hit& hit, int face, const Vec2& place) const;

  const FrameInput& in_;
  const raster::LightRecord& record_;
  const LightView& view_;
};

}  // namespace gnomon::judge
