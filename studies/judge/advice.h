// Which bias would have mended the picture, as a number of the renderer that drew it.
#pragma once

#include "compare/comparison.h"
#include "compare/result/judged.h"
#include "studies/judge/captured_frame.h"

namespace gnomon::compare {

/// The best constant with the renderer's own normal offset, and the best normal offset of a few with the best
/// constant beside it: smaller ones than the present one, none among them, and larger ones. Shares are what the hard test with that bias draws wrong.
std::vector<Advice> give_advice(const FrameInput& input, const raster::Bias& bias,
                                const LightComparison& light, const raster::LightRecord& record);

}  // namespace gnomon::compare
