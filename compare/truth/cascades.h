// What cascades draw of a receiver, whichever of them it belongs to, in double precision: the twin of
// shaders/technique/cascade_blend.glsl, and the seams that can be counted with it.
#pragma once

#include "compare/ladder/ladder.h"
#include "scene/image.h"

namespace gnomon::compare {

/// The next cascade's share, in [0, 1], of a receiver at `own`; `blend`: CascadeOptions::blend.
double share_of_next(const LightView& view, const TexelCoordinate& own, double blend);

/// The visibility that csm gives a receiver which belongs to cascade `face`. `drawn`: the options that drew the record.
double cascade_visibility(const raster::LightRecord& record, const raster::MapOptions& drawn,
                          const Light& light, const raytrace::SurfacePoint& receiver, int face);

/// Compared receivers beside whose pixel, up, down, left or right, the same surface looks up another cascade, and those
/// of them that the other cascade would draw on the other side of one half. Nothing of other techniques, of another
/// renderer's map, where a shader of the user's own drew, and where the map was not handed on. Counted in those rows of
/// the images; the rows beside them must be there.
std::optional<SeamCount> count_seams(const LadderInput& in, const Image<Label>& labels,
                                     const PictureRows& rows);

}  // namespace gnomon::compare
