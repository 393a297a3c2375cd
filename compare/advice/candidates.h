// What may help a light, told from its labels and its budget without a drawing: what is worth one.
#pragma once

#include <vector>

#include "compare/comparison.h"

namespace gnomon::compare {

struct Candidate {
  raster::MapOptions map;
  bool alone = false;  ///< where it helps, the ones after it are not needed
};
/// Settings that differ from the drawing's in one thing and may leave clearly less of this light, the likeliest first.
std::vector<Candidate> candidates(const Comparison& comparison, const LightComparison& light);

/// Returns the drawing's options as they are asked for: what a filter's plane makes of the bias (raster::effective_options) is not.
raster::MapOptions asked_options(const Comparison& comparison);

/// Tells whether most of the error is that a light with size was taken for its centre, and no filter makes up for most of it.
bool lacks_light_size(const raster::RasterFrame& drawn, const LightComparison& light);
/// Tells whether most of what is wrong lies outside a window that was given, where neither a bias nor texels help.
bool lacks_window(const Comparison& comparison, const LightComparison& light);

/// Returns how often a map's size can be halved until a texel is too wide for edges that are off by half a pixel. `pixels`: a
/// texel's side now, in pixels of the picture.
int halvings(int size, double pixels);

/// "--technique pcss", "--bleeding-reduction 0.5", "--slope-bias 3 --bias 0.2texel": what asks for these options in place
/// of the drawn ones.
std::string changed_arguments(const raster::MapOptions& map, const raster::MapOptions& drawn);

}  // namespace gnomon::compare
