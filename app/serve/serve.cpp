#include "app/serve/serve.h"

#include <fmt/core.h>

#include <cstdio>

#include "app/console.h"
#include "app/process/interrupt.h"
#include "app/serve/lab_engine.h"

namespace gnomon::app {

Expected<ExitCode> run_serve(const ServeOptions& options) {
  Console console(options.quiet);
  RunFiles files;
  files.reads(options.scene);
  auto loaded = load(options.scene, files, console, options.tessellate, options.camera, true);
  if (!loaded) return fail(loaded.error());
  keep_strongest_lights(*loaded, options.max_lights, named_lights(options.light), options.poses, console);
  if (options.exposure) loaded->scene->exposure = *options.exposure;
  const TemporaryFolder folder("gnomon-serve");
  if (folder.path().empty())
    return fail(ErrorKind::cannot_write, "no folder can be made for what is dropped on the page");
  SceneSource source{options.scene, options.camera, std::make_shared<const LoadedScene>(std::move(*loaded)),
                     files.inputs()};
  auto engine = LabEngine::start(options, std::move(source));
  if (!engine) return fail(engine.error());
  const auto server = LabServer::open(options.place, **engine, options, folder.path());
  if (!server) return fail(server.error());
  print_data(fmt::format("{}\n", (*server)->url()));
  std::fflush(stdout);
  console.message("open this address in a browser; it is the only key to the lab. Ctrl+C ends it.");
  if (const auto ran = (*server)->run(); !ran) return fail(ran.error());
  return ExitCode::done;
}

}  // namespace gnomon::app
