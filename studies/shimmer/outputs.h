// Everything that a film of shadows is written as.
#pragma once

#include <string>
#include <string_view>

#include "report/shell.h"
#include "scene/base/expected.h"
#include "scene/files/staged_files.h"
#include "studies/shimmer/film.h"
#include "studies/shimmer/shimmer.h"

namespace gnomon::studies {

struct ShimmerProvenance {
  std::string command;  ///< as the user could type it again
  std::uint64_t seed = 0;
  double total_ms = 0.0;
};

/// Flips over all pairs of following frames and receivers, a second.
double flips_per_receiver_second(const ShimmerOptions& options, const ShimmerLight& light);

/// World area that the drawn and the true shadow sweep, over the length of the true shadow's edge: how fast the
/// edges go, back and forth counting alike. NaN where there is no edge.
struct EdgeSpeed {
  double drawn_world_per_second = std::numeric_limits<double>::quiet_NaN();
  double true_world_per_second = std::numeric_limits<double>::quiet_NaN();
  double drawn_texels_per_frame = std::numeric_limits<double>::quiet_NaN();  ///< of the first frame's map
  double true_texels_per_frame = std::numeric_limits<double>::quiet_NaN();
};
EdgeSpeed edge_speed(const ShimmerOptions& options, const ShimmerLight& light);

/// The result file (studies/shimmer/shimmer.schema.json), schema "gnomon/shimmer/1".
std::string shimmer_json(const Shimmer& shimmer, const ShimmerProvenance& from);
/// One plain sentence on one light.
std::string shimmer_sentence(const Shimmer& shimmer, const ShimmerLight& light);
/// The summary for stdout, at most 80 columns wide.
std::string shimmer_table(const Shimmer& shimmer);

// Films as files: animated PNG by the program itself, MP4 through ffmpeg, which need not be installed.

enum class FilmFormat : std::uint8_t { apng, mp4 };
/// "png", "mp4".
std::string_view film_extension(FilmFormat format);
/// "animated PNG", "MP4".
std::string_view film_format_words(FilmFormat format);

/// Error (usage): the format needs a program that is not there.
Expected<void> check_film_format(FilmFormat format);

/// H.264 in an MP4 file from an animated PNG of `pixels` in all its frames; a side of an odd number of pixels gets one more,
/// black. Errors: ffmpeg says that something is wrong (cannot write); it cannot be started, or does not end (resources).
Expected<void> convert_to_mp4(const std::string& apng, const std::string& mp4, double pixels);

// The page of a film of shadows: its document, and the data of the film that scripts play.

/// Builds the page; if it has more than `max_mb` megabytes the frames are files beside it. `json`: result.json's text.
Expected<report::BuiltPage> shimmer_page(const Shimmer& shimmer, const FilmRecorder& films,
                                         std::string_view json, double max_mb, FilmFormat format);

// The folder of a film of shadows.

inline constexpr double default_film_max_mb = 20.0;  ///< megabytes, of a page that is one file

struct ShimmerFolder {
  std::string folder;
  double report_max_mb = default_film_max_mb;
  std::vector<std::string> inputs{};  ///< files that must not be replaced: ErrorKind::usage
  FilmFormat film = FilmFormat::apng;
  std::vector<FileText> elsewhere{};  ///< files that appear with the folder, wherever they lie
};

/// result.json, report.html and, for each light, film-I-drawn, film-I-truth and film-I-flips (.png, animated, or .mp4),
/// in a folder that appears whole (scene/files/staged_folder.h). Returns what the page weighs, megabytes.
Expected<double> write_shimmer(const Shimmer& shimmer, const FilmRecorder& films, const std::string& json,
                               const ShimmerFolder& output);

}  // namespace gnomon::studies
