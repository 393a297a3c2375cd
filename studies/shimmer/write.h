// The folder of a film of shadows.
#pragma once

#include "studies/shimmer/page.h"

namespace gnomon::compare {

inline constexpr double default_film_max_mb = 20.0;  ///< megabytes, of a page that is one file

struct ShimmerFolder {
  std::string folder;
  double report_max_mb = default_film_max_mb;
  std::vector<std::string> inputs{};  ///< files that must not be replaced: ErrorKind::usage
  FilmFormat film = FilmFormat::apng;
};

/// result.json, report.html and, for each light, film-I-drawn, film-I-truth and film-I-flips (.png, animated, or .mp4),
/// in a folder that appears whole (scene/files/staged_folder.h). Returns what the page weighs, megabytes.
Expected<double> write_shimmer(const Shimmer& shimmer, const FilmKeeper& films, const std::string& json,
                               const ShimmerFolder& output);

}  // namespace gnomon::compare
