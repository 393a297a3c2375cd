// The bias that lies in a captured map: casters that were moved from the light while it was drawn (polygon offset, or depths
// moved by a shader). It is the capture's, or is found where one rule moves nearly every texel's depth. It is taken out of
// the stored depths. So it is charged to the ladder's bias step and can be advised on.
#pragma once

#include <string>
#include <vector>

#include "compare/result/judged.h"
#include "judge/captured_frame.h"

namespace gnomon::judge {

/// What moved the casters of a map, by face.
struct CasterBiases {
  std::vector<CapturedCasterBias> faces;  ///< empty: casters are where they are
  bool found = false;                     ///< the capture does not say it
  /// By texel of the map, the larger change of its surface's stored depth from texel to texel; 0 where nothing of the
  /// scene is stored.
  std::vector<float> slopes;
  /// The same of the cosine of the angle between normal and light.
  std::vector<float> cosines;
};

/// Fills `record.map.unbiased` where casters were moved; `given`: by face what the capture says. A texel holds the surface on
/// the ray through its centre whose depth, so moved, is nearest to the stored one. Without the bias it holds the first surface
/// that was not moved to before that. An empty one holds the first surface, where the bias moves that to the far end. In maps of
/// moments none is looked for.
CasterBiases take_out_caster_bias(const FrameInput& input, const std::vector<CapturedCasterBias>& given,
                                  raster::LightRecord& record);

/// Returns the map's numbers as they are with this bias in place of what moved the casters of its faces, all else alike. A normal
/// offset stays or becomes 0: outlines are not moved to a third place.
std::vector<float> with_caster_bias(const raster::ShadowMap& map, const CasterBiases& casters,
                                    const CapturedCasterBias& instead);

/// That a bias of casters was found, as a sentence.
std::vector<std::string> caster_bias_notes(const CasterBiases& casters, const raster::LightRecord& record);

}  // namespace gnomon::judge
