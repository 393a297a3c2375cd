// What the hard test draws of a receiver in any one of a light's several maps, cascades or faces of a cube, in double
// precision. Of cascades it is the twin of shaders/technique/cascade_blend.glsl. Seams can be counted with it.
#pragma once

#include "compare/ladder/ladder.h"
#include "scene/image.h"

namespace gnomon::compare {

/// The next cascade's share, in [0, 1], of a receiver at `own`; `blend`: CascadeOptions::blend.
double share_of_next(const LightView& view, const TexelCoordinate& own, double blend);

/// The visibility that the hard test gives a receiver which belongs to that cascade, or that face of a cube, which goes
/// on past its border as its outermost texels. `drawn`: the options that drew the record.
double visibility_by_face(const raster::LightRecord& record, const raster::MapOptions& drawn,
                          const Light& light, const raytrace::SurfacePoint& receiver, int face);

/// Counts compared receivers beside whose pixel, up, down, left or right, the same surface looks up another cascade or
/// another face of a cube. Counts also those of them that the other one would draw on the other side of one half.
/// Nothing of techniques that filter, of one map, of another renderer's map, where a shader of the user's own drew, and
/// where the map was not handed on. Counted in those rows of the images; the rows beside them must be there.
std::optional<SeamCount> count_seams(const LadderInput& in, const Image<Label>& labels,
                                     const PictureRows& rows);

}  // namespace gnomon::compare
