// The program `gnomon`, and those of other rooms: what commands they have is linked.
#include <csignal>

#include "app/command_line.h"
#include "app/console.h"
#include "app/other_programs.h"
#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "scene/base/freed_memory.h"
#include "scene/base/stages.h"

namespace {

int run(int argc, char** argv) {
  const gnomon::StageLog stages;  // first of all, so that the account begins with the process
  gnomon::keep_freed_memory();
  // A limit on the size of files is then an error of the write that meets it. It does not end the process where the
  // driver writes its cache of compiled shaders.
  std::signal(SIGXFSZ, SIG_IGN);
  gnomon::app::end_in_words_without_threads();
  gnomon::app::watch_for_interrupts();
  return gnomon::app::run_command_line(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  if (const auto is_it = gnomon::app::become_program_of_command(argc, argv); !is_it) {
    gnomon::app::print_error(is_it.error());
    return static_cast<int>(is_it.error().kind);
  }
  return gnomon::app::with_enough_stack(run, argc, argv);
}
