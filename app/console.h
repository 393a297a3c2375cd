// What the program says and where: data on stdout, everything else on stderr.
#pragma once

#include <string>
#include <string_view>

#include "scene/base/expected.h"

namespace gnomon::app {

/// Onto stdout: lines of text, or JSON. Control characters that came with names are escaped (plain_lines() in
/// scene/base/expected.h), but for the program's own styles where stdout takes colour.
void print_data(std::string_view text);

/// Whether nobody reads stdout any more, so that a word there would end the program (SIGPIPE).
bool stdout_has_no_reader();

/// Whether all data got there.
bool data_reached_stdout();

/// Lines on stderr, escaped likewise; a line break is added where there is none.
void print_error(const std::string& text);
/// An input's error as file:line:column: reason, any other after the program's name.
void print_error(const Error& error);

/// Messages and progress, silent when asked to be quiet. The progress line appears on a terminal only.
class Console {
 public:
  explicit Console(bool quiet);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// One line; control characters in it are escaped (scene/base/expected.h).
  void message(const std::string& text);
  /// Lines of the program's own, with no word from a file.
  void lines(const std::string& text);
  /// What a loader made up or could not use.
  void note(const std::string& text) { message("note: " + text); }
  /// Redraws the progress line when its text would change; done is in [0, 1].
  void progress(std::string_view stage, double done);
  void clear_progress();

 private:
  bool quiet_;
  bool shows_progress_;
  std::string line_;  ///< the progress line as it stands on the terminal
};

/// stdout is a terminal that takes colour, and NO_COLOR (no-color.org) does not forbid it.
bool stdout_takes_colour();

}  // namespace gnomon::app
