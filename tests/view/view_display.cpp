#include "tests/view/view_display.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gnomon::app_test {

namespace {

/// Xvfb writes the number of the display that it found free, and a line break, when it takes connections.
std::string read_line(int stream) {
  std::string line;
  for (char c = 0; read(stream, &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

}  // namespace

VirtualDisplay::VirtualDisplay() {
  int ends[2];
  if (pipe(ends) != 0) {
    missing_ = "no pipe";
    return;
  }
  process_ = fork();
  if (process_ == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    close(ends[0]);
    const std::string stream = std::to_string(ends[1]);
    execlp("Xvfb", "Xvfb", "-displayfd", stream.c_str(), "-screen", "0", "1280x1024x24", "-nolisten", "tcp",
           static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  number_ = read_line(ends[0]);
  close(ends[0]);
  if (number_.empty()) missing_ = "Xvfb is not there or does not start (Debian package xvfb)";
}

VirtualDisplay::~VirtualDisplay() {
  if (process_ <= 0) return;
  kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
}

}  // namespace gnomon::app_test
