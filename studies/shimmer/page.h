// The page of a film of shadows: its document, and the data of the film that scripts play.
#pragma once

#include "report/shell.h"
#include "studies/shimmer/film.h"
#include "studies/shimmer/film_file.h"
#include "studies/shimmer/outputs.h"

namespace gnomon::compare {

/// Of more than `max_mb` megabytes the frames are files beside the page. `json`: result.json's text.
Expected<BuiltPage> shimmer_page(const Shimmer& shimmer, const FilmKeeper& films, std::string_view json,
                                 double max_mb, FilmFormat format);

}  // namespace gnomon::compare
