// The commands that the program has, in the order in which --help lists them.
#include "app/invocation.h"
#include "app/options/options.h"

namespace gnomon::app {

void add_commands(CLI::App& program, Invocation& invocation) {
  add_compare(program, invocation);
  add_raster(program, invocation);
  add_raytrace(program, invocation);
  add_plan(program, invocation);
  add_scenes(program, invocation);
  add_shaders(program, invocation);
  add_sweep(program, invocation);
  add_export(program, invocation);
  add_merge(program, invocation);
  add_tune(program, invocation);
  add_verify(program, invocation);
  add_bench(program, invocation);
  add_shimmer(program, invocation);
  add_judge(program, invocation);
  add_grade(program, invocation);
  add_lessons(program, invocation);
  add_site(program, invocation);
  add_serve(program, invocation);
  add_view(program, invocation);
}

}  // namespace gnomon::app
