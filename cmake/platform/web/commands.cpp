// The commands that a page and Node have: all but those of windows, of other programs and of the machine's own hardware
// (app/commands/all.cpp).
#include "app/invocation.h"

namespace gnomon::app {

void add_commands(CLI::App& program, Invocation& invocation) {
  add_compare(program, invocation);
  add_raster(program, invocation);
  add_raytrace(program, invocation);
  add_plan(program, invocation);
  add_scenes(program, invocation);
  add_shaders(program, invocation);
  add_export(program, invocation);
  add_judge(program, invocation);
  add_tune(program, invocation);
}

}  // namespace gnomon::app
