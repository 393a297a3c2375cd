// Films as files: animated PNG by the program itself, MP4 through ffmpeg, which need not be installed.
#pragma once

#include <string>
#include <string_view>

#include "scene/base/expected.h"

namespace gnomon::compare {

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

}  // namespace gnomon::compare
