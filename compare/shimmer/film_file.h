// Films as files: animated PNG by the program itself, MP4 through ffmpeg, which need not be installed.
#pragma once

#include <string>
#include <string_view>

#include "scene/expected.h"

namespace gnomon::compare {

enum class FilmFormat : std::uint8_t { apng, mp4 };
/// "png", "mp4".
std::string_view film_extension(FilmFormat format);
/// "animated PNG", "MP4".
std::string_view film_format_words(FilmFormat format);

/// Error (usage): the format needs a program that is not there.
Expected<void> check_film_format(FilmFormat format);

/// H.264 in an MP4 file from an animated PNG; a side of an odd number of pixels gets one more, black. Error (cannot
/// write): ffmpeg cannot be started, or says that something is wrong.
Expected<void> convert_to_mp4(const std::string& apng, const std::string& mp4);

}  // namespace gnomon::compare
