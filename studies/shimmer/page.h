// The page of a film of shadows: what can be read without scripts, and the data of the film that scripts play.
#pragma once

#include "report/shell.h"
#include "studies/shimmer/film.h"
#include "studies/shimmer/film_file.h"
#include "studies/shimmer/outputs.h"

namespace gnomon::compare {

/// Of more than `max_mb` megabytes the frames are files beside the page. `json`: result.json's text.
Expected<BuiltPage> shimmer_page(const Shimmer& shimmer, const FilmKeeper& films, const std::string& command,
                                 std::string_view json, double max_mb, FilmFormat format);

/// Flips and true changes from frame to frame, as inline SVG.
std::string flips_chart(const Shimmer& shimmer, const ShimmerLight& light, std::size_t index);

}  // namespace gnomon::compare
