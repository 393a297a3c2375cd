// The hard-shadow pass: every receiver that the light reaches is classified by the light's sheets, and what
// they leave ambiguous is traced, tile by tile, through the tracer's packets. The visibilities are the tracer's own
// wherever it is certain itself.
//
// When sheets pay. A ray costs the packets some 20 ns, less than a texel's sheets. So no sheets are worth
// their build for a single frame of a picture: they are, when the light stands still for a while. Who asks
// for speed (Sheets::when_they_pay) therefore gets a new light traced, but for receivers beside the map,
// which no map is needed for. Sheets are built once tracing has cost as much as they would have. By the rule
// of Karlin et al. 1988 ("Competitive snoopy caching") that costs never more than twice the cheaper of the
// two. The estimate counts triangles, texels and receivers, not milliseconds, so that runs repeat.
#pragma once

#include "hybrid/light_sheets.h"
#include "raster/external_visibility.h"
#include "raytrace/receiver_tiles.h"

namespace gnomon::hybrid {

/// When more than this share of the receivers is ambiguous, their texels are looked at more closely, once. Rays
/// are cheap: to refine a texel costs as much as tens of them, and pays when light and camera stand still. So
/// it is done for the first receivers that ask, and afterwards for receivers that ask for the second time.
inline constexpr double refine_above = 0.03;

enum class Sheets : std::uint8_t { at_once, when_they_pay };

/// What a light has ready for its rays and receivers. Good as long as world and light stand still.
class LightCache {
 public:
  /// Sheets::at_once builds them here.
  LightCache(const raytrace::Tracer& tracer, const raytrace::Topology& topology, const Light& light,
             const LightView& view, Sheets when = Sheets::at_once);
  /// Frames that a light must stand still before its sheets pay.
  std::uint64_t frames_to_pay(std::uint64_t pixels) const;
  std::uint64_t bytes() const;
  double build_ms() const { return sheets.stats().build_ms; }

  Light light;
  LightSheets sheets;
  double share_left = 0.0;   ///< of the receivers, ambiguous after the sheets were last refined
  std::uint64_t frames = 0;  ///< that the light has been looked at
  std::optional<std::uint64_t>
      pattern;  ///< a hash of which receivers the sheets left ambiguous, in the last frame

 private:
  std::uint64_t triangles_;
};

struct ShadowCounts {
  std::uint64_t asked = 0;  ///< receivers that the light can reach: the rays of the pure ray tracer
  std::uint64_t lit = 0, shadowed = 0;  ///< surely
  std::uint64_t rays = 0;               ///< cast for the others
};

using raster::Decision;

/// Fills `visibility`: lit where there is no receiver, shadowed where the light cannot reach, as in
/// raytrace::LightTruth. May refine the light's sheets. `decisions` (or null) says who decided.
ShadowCounts trace_hard_shadows(const raytrace::Tracer& tracer, LightCache& cache,
                                const raytrace::Receivers& receivers,
                                Image<raytrace::PointVisibility>& visibility, Image<Decision>* decisions);

}  // namespace gnomon::hybrid
