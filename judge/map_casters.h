// Which caster of the scene a captured map lacks, holds elsewhere or holds moved, told by what the rays through texels'
// centres meet. What holds of a texel alone is told by it. Whether an object is missing, moved or biased is told by all of
// its texels that were looked at. These are a grid over the map, and those that wrong pixels look up.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"
#include "judge/stored_depths.h"

namespace gnomon::judge {

/// How the scene's casters stand in one texel.
struct CasterTexel {
  raytrace::TexelKey key;
  std::vector<SurfaceOnRay> surfaces;  ///< the first is what the map should hold
  bool held = false;                   ///< the map holds the scene's depth
  bool held_at_centre = false;
  std::optional<std::size_t> stored{};  ///< the surface whose depth the map holds instead
  std::optional<SurfaceOnRay>
      hole{};  ///< the hole of a mask before the first surface whose depth the map holds, or has not
  bool fills_hole = false;  ///< it holds that
  double depth = infinity;  ///< as stored
  bool empty = false;

  bool has_first() const { return !surfaces.empty(); }
  const SurfaceOnRay& first() const { return surfaces.front(); }
  /// Stored nearer than all that the scene has there, or in the middle of nothing.
  bool is_foreign() const { return !held && !empty && !stored; }
};

/// A line depth = constant + scale * across that moves casters away from the light.
struct CasterLine {
  double constant = 0.0, scale = 0.0;
  double at(const SurfaceOnRay& surface) const { return constant + scale * surface.across; }
};

/// The scene as a map's pass draws it that does not test alpha.
struct Unmasked {
  explicit Unmasked(const World& masked);
  Scene scene;
  World world;
  raytrace::Tracer tracer;
};

/// The map's texels that were looked at, and what they tell of each object.
class MapCasters {
 public:
  MapCasters(const FrameInput& in, const raster::RasterFrame& drawn);

  /// Looks at these texels and at a grid over the map.
  void look_at(std::vector<raytrace::TexelKey> keys);
  /// Finds what holds of whole objects, of the texels that were looked at.
  void judge_objects();
  /// Nothing: the map holds the scene's depth there, and what is off is precision.
  std::optional<compare::Label> label_of(raytrace::TexelKey key, bool false_shadow) const;
  /// One that was looked at.
  const CasterTexel& texel(raytrace::TexelKey key) const {
    const auto found = std::lower_bound(texels_.begin(), texels_.end(), key,
                                        [](const CasterTexel& t, raytrace::TexelKey k) { return t.key < k; });
    return *found;
  }
  std::string object_name(std::uint32_t primitive) const;
  std::uint32_t object(const SurfaceOnRay& s) const { return in_.world.object_of(s.primitive); }
  /// Whether the map holds some of the object where it is the first that the light meets: moved by a bias, or its other
  /// side, too.
  bool holds_some_of(std::uint32_t object) const;
  /// How far a bias of casters moves the first surface there.
  double moved_by(const CasterTexel& t) const {
    const CasterLine* bias = t.has_first() ? bias_of(object(t.first())) : nullptr;
    return bias != nullptr ? bias->at(t.first()) : 0.0;
  }

 private:
  struct Share {
    std::size_t texels = 0, held = 0;
    double of_held() const { return texels > 0 ? double(held) / double(texels) : 1.0; }
  };
  CasterTexel look(raytrace::TexelKey key) const;
  void look_for_hole(CasterTexel& t) const;
  bool is_clipped(const SurfaceOnRay& s, raytrace::TexelKey key) const {
    const LightFace& face = record_.map.view.face(key.face());
    return s.depth < face.near_depth || s.depth > face.far_depth;
  }
  void find_bias(const std::vector<const CasterTexel*>& group, std::optional<CasterLine>& out) const;
  const CasterLine* bias_of(std::uint32_t object) const;
  bool is_biased(const CasterTexel& t) const;
  bool is_biased_object(const SurfaceOnRay& s) const;
  bool is_culled(const CasterTexel& t) const;
  /// A map of back faces holds that of the first surface's object.
  bool holds_other_side(const CasterTexel& t) const {
    return map_.cull != raster::Cull::none && t.stored && object(t.surfaces[*t.stored]) == object(t.first());
  }
  bool is_masked_out(const CasterTexel& t) const;
  bool is_pushed_out(const CasterTexel& t) const;
  compare::Label missing_label(const CasterTexel& t) const;

  const FrameInput& in_;
  const raster::MapOptions& map_;
  const raster::LightRecord& record_;
  StoredDepths stored_;
  std::unique_ptr<Unmasked> unmasked_;  ///< null: no material has a mask
  std::vector<CasterTexel> texels_;     ///< ascending by key
  Share all_, fronts_, backs_;
  std::map<std::uint32_t, Share> objects_;
  std::map<std::uint32_t, Share>
      holes_;  ///< texels of each object's holes, and those of them that the map fills
  std::size_t foreign_ = 0;
  std::optional<CasterLine> whole_bias_;
  std::map<std::uint32_t, CasterLine> object_bias_;
  std::map<std::uint32_t, std::size_t> biased_;  ///< texels of each object that a bias of casters explains
};

}  // namespace gnomon::judge
