// The program `gnomon`.
#include "app/command_line.h"
#include "app/interrupt.h"

int main(int argc, char** argv) {
  gnomon::app::watch_for_interrupts();
  return gnomon::app::run_command_line(argc, argv);
}
