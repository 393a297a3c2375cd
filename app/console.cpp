#include "app/console.h"

#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "scene/base/expected.h"
#include "scene/base/interrupted.h"
#include "scene/base/terminal.h"

namespace gnomon::app {

namespace {

std::atomic<bool> data_is_lost{false};  ///< some of the data

}  // namespace

void print_data(std::string_view text) {
  constexpr std::array<std::string_view, 3> styles{"\x1b[0m", "\x1b[1m", "\x1b[2m"};
  const std::string plain =
      plain_lines(text, stdout_takes_colour() ? std::span<const std::string_view>(styles)
                                              : std::span<const std::string_view>());
  for (std::string_view rest = plain; !rest.empty() && !data_is_lost;) {
    const ssize_t written = uninterrupted([&] { return ::write(STDOUT_FILENO, rest.data(), rest.size()); });
    if (written < 0)
      data_is_lost = true;
    else
      rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

bool stdout_has_no_reader() {
  pollfd place{STDOUT_FILENO, POLLOUT, 0};
  return poll(&place, 1, 0) > 0 && (place.revents & POLLERR) != 0;
}

bool data_reached_stdout() {
  return !data_is_lost;
}

void print_error(const std::string& text) {
  const std::string line = plain_lines(text.ends_with('\n') ? text : text + "\n");
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void print_error(const Error& error) {
  print_error(error.file.empty() ? "gnomon: " + error.message() : error.message());
}

Console::Console(bool quiet) : quiet_(quiet), shows_progress_(!quiet && is_terminal(STDERR_FILENO)) {}

Console::~Console() {
  clear_progress();
}

void Console::message(const std::string& text) {
  lines(one_line(text));
}

void Console::lines(const std::string& text) {
  if (quiet_) return;
  clear_progress();
  print_error(text);
}

void Console::progress(std::string_view stage, double done) {
  if (!shows_progress_) return;
  constexpr int width = 24;  // columns of the bar
  const double share = std::clamp(done, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(std::lround(share * width));
  const std::string line =
      fmt::format("[{:<{}}] {:3.0f} % {}", std::string(filled, '#'), width, 100.0 * share, one_line(stage));
  if (line == line_) return;
  clear_progress();
  line_ = line;
  std::fputs(line_.c_str(), stderr);
  std::fflush(stderr);
}

void Console::clear_progress() {
  if (line_.empty()) return;
  std::fputs("\r\033[K", stderr);
  line_.clear();
}

bool stdout_takes_colour() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool forbidden = no_color != nullptr && *no_color != '\0';
  const bool dumb = terminal == nullptr || std::string_view(terminal) == "dumb";
  return !forbidden && !dumb && is_terminal(STDOUT_FILENO);
}

}  // namespace gnomon::app
