// Pictures of what the map says, in the report page's colours: the true shadow, the gap, and the map's texels
// where they lie on the surfaces.
#pragma once

#include "compare/comparison.h"

namespace gnomon::app {

/// Visibility V0 in grey: white lit, black shadowed; dark grey where nothing is compared.
Rgb8Image truth_picture(const compare::LightComparison& light);
/// The gap, from white (none) to the colour of false shadow at gap_scale_texels and of missed shadow at minus
/// as many.
Rgb8Image gap_picture(const raster::LightRecord& record, const compare::LightComparison& light);
inline constexpr double gap_scale_texels = 4.0;
/// The drawn picture in grey under the map's texels, light and dark in turn as on a chess board; each face or
/// cascade in a tint of its own. Texels that would be finer than the pixels are left out.
Rgb8Image texel_picture(const Rgb8Image& drawn, const raster::LightRecord& record,
                        const compare::LightComparison& light);

}  // namespace gnomon::app
