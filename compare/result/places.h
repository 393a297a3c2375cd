// Where errors lie in the scene, over several views. It is a grid of squares seen from above, in the plane of the world's x
// and z. Each has the errors of all pixels that show it. The page draws it (report/page/src/views_section.ts).
#pragma once

#include "compare/comparison.h"
#include "compare/result/result_parts.h"

namespace gnomon::compare {

/// Returns an empty grid over the scene's finite part and half of its longer side around it; where the scene has no finite
/// part, around what the camera looks at.
ErrorPlaces places_of(const World& world, const Camera& camera);

/// Adds the compared pixels of one light: `truth` and `drawn` are visibilities. The images show the same rows.
void add_errors(const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                const Image<float>& truth, const Image<float>& drawn, ErrorPlaces& places);

/// Returns the square with most of the error, as an index in ErrorPlaces::cells; none where nothing is off.
std::optional<std::size_t> worst_place(const ErrorPlaces& places);
/// Returns the share of all error, that of pixels beyond the grid included, which lies in a square.
double share_of_error(const ErrorPlaces& places, std::size_t cell);
/// Returns "Most error around x 3.2, z -1 (12 % of it)."; nothing where nothing is off or was counted.
std::string places_line(const ErrorPlaces& places);
/// Makes "places" of "views" in result.json.
Json places_json(const ErrorPlaces& places);

}  // namespace gnomon::compare
