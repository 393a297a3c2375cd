#include "judge/recorded_frame.h"

#include <fmt/core.h>

#include <filesystem>
#include <sstream>

#include "scene/base/run_program.h"
#include "scene/files/own_program.h"
#include "scene/files/path_status.h"

namespace gnomon::judge {
namespace {

constexpr double longest_s = 600.0;

tl::unexpected<Error> frame_error(const std::string& frame, ErrorKind kind, std::string reason) {
  Error error{kind, std::move(reason)};
  error.file = frame;
  return fail(std::move(error));
}

/// The script beside the installed program (bin and share/gnomon), else where it lies in the sources.
std::string script() {
  const std::string installed = (own_program().parent_path() / GNOMON_RENDERDOC_FROM_BIN).string();
  return file_kind_or_none(installed) == FileKind::folder ? installed : GNOMON_RENDERDOC_SOURCE;
}

/// What follows a word at the beginning of a line: the script marks its own lines so, for drivers talk, too.
std::vector<std::string> lines_with(const std::string& said, std::string_view word, bool keep_word) {
  std::vector<std::string> lines;
  std::istringstream text(said);
  for (std::string line; std::getline(text, line);)
    if (line.starts_with(word)) lines.push_back(keep_word ? line : line.substr(word.size()));
  return lines;
}

ErrorKind kind_of(int code) {
  return code == 2   ? ErrorKind::usage
         : code == 3 ? ErrorKind::bad_input
         : code == 4 ? ErrorKind::cannot_write
                     : ErrorKind::graphics;
}

/// Debian's own Python has the module for RenderDoc; another one of the PATH does not.
std::string python() {
  return file_kind_or_none("/usr/bin/python3") == FileKind::file ? "/usr/bin/python3" : "python3";
}

/// What a script said that ended well; else its error, or `what` and the code with which it ended.
Expected<std::string> said_by(const Expected<ProgramEnd>& end, const std::string& file,
                              std::string_view what) {
  if (!end) return frame_error(file, end.error().kind, end.error().reason);
  if (end->code == 0) return end->said;
  const auto errors = lines_with(end->said, "error: ", false);
  if (errors.empty())
    return frame_error(file, ErrorKind::graphics, fmt::format("{} ended with code {}", what, end->code));
  return frame_error(file, kind_of(end->code), errors.front());
}

Expected<std::string> run_script(const std::string& frame, std::vector<std::string> options) {
  if (const auto there = size_of_file(frame); !there) return fail(there.error());
  std::vector<std::string> words{"prlimit", "--as=16000000000", python(),
                                 "-B",      script(),           (frame.starts_with('-') ? "./" : "") + frame};
  words.insert(words.end(), options.begin(), options.end());
  return said_by(run_and_listen(std::move(words), longest_s), frame, "the replay");
}

}  // namespace

bool is_recorded_frame(std::string_view path) {
  return path.ends_with(".rdc");
}

bool is_page(std::string_view word) {
  const auto begins = [&](std::string_view with) { return word.starts_with(with); };
  return begins("http://") || begins("https://") || begins("file://") || word.ends_with(".html") ||
         word.ends_with(".htm");
}

Expected<std::string> record_page(const std::string& page, const std::string& frame,
                                  const std::function<void(std::string)>& said) {
  const auto on_line = [&](std::string_view line) {
    constexpr std::string_view note = "note: ";
    if (line.starts_with(note)) said(std::string(line.substr(note.size())));
  };
  const auto end = run_and_listen({python(), "-B", script() + "/record.py", "-o", frame, "--page=" + page},
                                  longest_s, on_line);
  const auto done = said_by(end, page, "the recording");
  if (!done) return fail(done.error());
  const auto engines = lines_with(*done, "engine: ", false);
  return engines.empty() ? std::string() : engines.front();
}

Expected<std::vector<std::string>> capture_recorded_frame(const std::string& frame, const std::string& folder,
                                                          const std::string& light,
                                                          const std::string& renderer) {
  std::vector<std::string> options{"--output", folder};
  if (!light.empty()) options.insert(options.end(), {"--light", light});
  if (!renderer.empty()) options.push_back("--name=" + renderer);
  const auto said = run_script(frame, std::move(options));
  if (!said) return fail(said.error());
  return lines_with(*said, "found: ", false);
}

Expected<std::vector<std::string>> recorded_lights(const std::string& frame) {
  const auto said = run_script(frame, {"--list"});
  if (!said) return fail(said.error());
  return lines_with(*said, "light ", true);
}

}  // namespace gnomon::judge
