// The hard-shadow pass: every receiver that the light reaches is classified by the light's sheets, and what
// they leave unsure is traced, tile by tile, through the tracer's packets. The verdicts are the tracer's own
// wherever it is certain itself.
#pragma once

#include "hybrid/light_sheets.h"
#include "hybrid/receivers.h"
#include "raytrace/packet/passes.h"
#include "scene/image.h"

namespace gnomon::hybrid {

/// When more than this share of the receivers is unsure, their texels are looked at more closely, once. Rays
/// are cheap: to refine a texel costs as much as tens of them, and pays when the light stands still.
inline constexpr double refine_above = 0.03;

/// What a light has ready for its rays and receivers. Good as long as world and light stand still.
struct LightCache {
  LightCache(const raytrace::Tracer& tracer, const raytrace::Topology& topology, const Light& light,
             const LightView& view);
  Light light;
  LightSheets sheets;
  std::optional<raytrace::Sight> sight;  ///< for packets of rays, as the pure tracer makes it for each frame
  double build_ms = 0.0;                 ///< of the sheets
  double share_left = 0.0;               ///< of the receivers, unsure after the sheets were last refined
  std::uint64_t bytes() const;
};

struct ShadowCounts {
  std::uint64_t asked = 0;  ///< receivers that the light can reach: the rays of the pure ray tracer
  std::uint64_t lit = 0, shadowed = 0;  ///< surely
  std::uint64_t rays = 0;               ///< cast for the others
};

/// Of one pixel.
enum class Decision : std::uint8_t { shadowed = 0, lit = 1, traced = 2, not_asked = 3 };

/// Fills `verdicts`: lit where there is no receiver, shadowed where the light cannot reach, as in
/// raytrace::LightTruth. May refine the light's sheets. `decisions` (or null) says who decided.
ShadowCounts trace_hard_shadows(const raytrace::Tracer& tracer, LightCache& cache, const Receivers& receivers,
                                Image<raytrace::Verdict>& verdicts, Image<Decision>* decisions);

}  // namespace gnomon::hybrid
