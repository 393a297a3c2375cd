#include "compare/shimmer/film_file.h"

#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <vector>

namespace gnomon::compare {
namespace {

constexpr const char* converter = "ffmpeg";

bool is_installed(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access(((folder.empty() ? "." : folder) + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

Expected<void> run(std::vector<std::string> words, const std::string& file) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto failed = [&file](std::string reason) {
    Error error{ErrorKind::cannot_write, std::move(reason)};
    error.file = file;
    return fail(std::move(error));
  };
  pid_t child = 0;
  if (const int status = posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ);
      status != 0)
    return failed(fmt::format("{} cannot be started: {}", words[0], std::strerror(status)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return failed(fmt::format("{}: {}", words[0], std::strerror(errno)));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return failed(fmt::format("{} could not make it", words[0]));
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

Expected<void> convert_to_mp4(const std::string& apng, const std::string& mp4) {
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
             mp4);
}

}  // namespace gnomon::compare
