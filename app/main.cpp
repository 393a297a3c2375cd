// The program `gnomon`.
#include "app/command_line.h"
#include "app/interrupt.h"
#include "scene/freed_memory.h"
#include "scene/stages.h"

int main(int argc, char** argv) {
  const gnomon::StageLog stages;  // first of all, so that the account begins with the process
  gnomon::keep_freed_memory();
  gnomon::app::watch_for_interrupts();
  return gnomon::app::run_command_line(argc, argv);
}
