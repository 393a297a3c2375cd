// Which bias would have mended the picture, as a number of the renderer that drew it.
#pragma once

#include "compare/comparison.h"
#include "compare/result/judged.h"
#include "studies/judge/caster_bias.h"

namespace gnomon::compare {

/// The best constant with the renderer's own normal offset, below 0, too, and the best normal offset of a few with the
/// best constant beside it: smaller ones than the present one, none among them, and larger ones. Shares are what the hard
/// test with that bias draws wrong, of all compared pixels: those outside the map stay as they were drawn. Nothing is
/// advised that is worse than the present setting. Where the casters have a bias the constant is theirs, and in place of
/// normal offsets slopes of casters are tried, the map's depths moved accordingly.
std::vector<Advice> give_advice(const FrameInput& input, const raster::RasterFrame& drawn,
                                const LightComparison& light, const CasterBiases& casters);

/// What an advice changes in an engine's settings (EngineUnit::engine); none where it sets the layers apart, or the engine
/// has no number for it.
std::vector<std::pair<std::string, double>> settings_in_engine(std::string_view engine, const Advice& advice,
                                                               LightType light,
                                                               const raster::LightRecord& record,
                                                               const World& world);

/// Where most wrong pixels lie outside the map: what helps.
std::vector<std::string> outside_map_notes(const FrameInput& input, const LightComparison& light,
                                           const raster::LightRecord& record);

}  // namespace gnomon::compare
