// Which bias would have mended the picture, as a number of the renderer that drew it.
#pragma once

#include "compare/comparison.h"
#include "compare/result/judged.h"
#include "judge/caster_bias.h"

namespace gnomon::judge {

/// The constant that leaves least; it may be below 0. Beside it stands the best normal offset of a few, with its best constant,
/// where that leaves clearly less. Tried are the present offset, smaller ones, none among them, and larger ones. Of layers it is
/// one constant in texels, or one each. Where the casters have a bias the constant is theirs. In place of normal offsets slopes
/// of casters are then tried, the map's depths moved accordingly. Each is drawn again with the filter (redrawing.h) over all
/// compared pixels. What is not worth advising is left out (compare/advice/rule.h); where nothing is worth it, nothing is
/// advised. `drawn_constant`: world units, of what was drawn, where that is not what the capture says.
std::vector<compare::Advice> give_advice(const FrameInput& input, const raster::RasterFrame& drawn,
                                         const compare::LightComparison& light, const CasterBiases& casters,
                                         double drawn_constant);

/// What an advice changes in an engine's settings (EngineUnit::engine) with this technique; none where it sets the layers apart,
/// or the engine has no number for it.
std::vector<std::pair<std::string, double>> settings_in_engine(std::string_view engine,
                                                               const compare::Advice& advice, LightType light,
                                                               raster::Technique technique,
                                                               const raster::LightRecord& record,
                                                               const World& world);

}  // namespace gnomon::judge
