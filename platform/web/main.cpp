// The program `gnomon` as a module: module.callMain(words) runs a command line over files in memory, as often as is asked.
#include "app/command_line.h"
#include "scene/base/stages.h"

int main(int argc, char** argv) {
  const gnomon::StageLog stages;
  return gnomon::app::run_command_line(argc, argv);
}
