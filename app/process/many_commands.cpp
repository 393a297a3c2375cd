#include "app/process/many_commands.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "scene/base/interrupted.h"
#include "scene/files/flushing.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

/// The next command's words, the program's name first; nothing where stdin ends.
std::vector<std::string> next_command() {
  std::vector<std::string> words{"gnomon"};
  for (std::string word; std::getline(std::cin, word, '\0');) {
    if (word.empty()) return words;
    words.push_back(word);
  }
  return {};
}

}  // namespace

int run_commands_from_stdin(int (*run)(int argc, const char* const* argv)) {
  leave_flushing_to_the_system();
  const Descriptor answers(dup(STDOUT_FILENO));
  {
    const Descriptor nothing(open("/dev/null", O_WRONLY));
    dup2(nothing.number(), STDOUT_FILENO);  // what a command prints is no answer
  }
  for (auto words = next_command(); !words.empty(); words = next_command()) {
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    const auto code = static_cast<std::uint8_t>(run(static_cast<int>(argv.size()), argv.data()));
    if (uninterrupted([&] { return write(answers.number(), &code, 1); }) != 1) break;
  }
  return 0;
}

}  // namespace gnomon::app
