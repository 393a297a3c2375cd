#include "app/run_options.h"

namespace gnomon::app {

void add_run_options(CLI::App& command, RunOptions& options) {
  add_backend(command, options.backend);
  add_threads(command, options.threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_exposure(command, options.exposure);
  add_seed(command, options.seed, "of the samples of lights with size; recorded in the result");
}

}  // namespace gnomon::app
