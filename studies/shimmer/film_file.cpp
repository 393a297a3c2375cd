#include "studies/shimmer/outputs.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <vector>

#include "scene/base/run_program.h"

namespace gnomon::studies {
namespace {

constexpr const char* converter = "ffmpeg";

bool is_installed(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access(((folder.empty() ? "." : folder) + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

/// Some thirty times what ffmpeg takes on one processor: 5 to 10 million pixels a second.
double longest_s(double pixels) {
  return 120.0 + 5e-6 * pixels;
}

Expected<void> run(std::vector<std::string> words, const std::string& file, double longest_s) {
  const auto code = run_program(std::move(words), longest_s);
  if (code && *code == 0) return {};
  Error error =
      code ? Error{ErrorKind::cannot_write, fmt::format("{} could not make it", converter)} : code.error();
  error.file = file;
  return fail(std::move(error));
}

}  // namespace

std::string_view film_extension(FilmFormat format) {
  return format == FilmFormat::mp4 ? "mp4" : "png";
}

std::string_view film_format_words(FilmFormat format) {
  return format == FilmFormat::mp4 ? "MP4" : "animated PNG";
}

Expected<void> check_film_format(FilmFormat format) {
  if (format == FilmFormat::apng || is_installed(converter)) return {};
  return fail(
      ErrorKind::usage,
      fmt::format("--film mp4: {} makes it, and is not installed (apng needs nothing else)", converter));
}

Expected<void> convert_to_mp4(const std::string& apng, const std::string& mp4, double pixels) {
  return run({converter,
              "-v",
              "error",
              "-nostdin",
              "-y",
              "-f",
              "apng",
              "-i",
              "file:" + apng,
              "-vf",
              "pad=ceil(iw/2)*2:ceil(ih/2)*2",
              "-c:v",
              "libx264",
              "-pix_fmt",
              "yuv420p",
              "-crf",
              "16",
              "-movflags",
              "+faststart",
              "file:" + mp4},
             mp4, longest_s(pixels));
}

}  // namespace gnomon::studies
