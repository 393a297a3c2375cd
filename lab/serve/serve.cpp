#include "lab/serve/serve.h"

#include <fmt/core.h>

#include "app/console.h"
#include "app/process/interrupt.h"
#include "lab/serve/lab_engine.h"

namespace gnomon::lab {

Expected<app::ExitCode> run_serve(const ServeOptions& options) {
  app::Console console(options.quiet);
  auto source = first_source(options, console);
  if (!source) return fail(source.error());
  const app::TemporaryFolder folder("gnomon-serve");
  if (folder.path().empty())
    return fail(ErrorKind::cannot_write, "no folder can be made for what is dropped on the page");
  auto engine = LabEngine::start(options, std::move(*source));
  if (!engine) return fail(engine.error());
  const auto server = LabServer::open(options.place, **engine, options, folder.path());
  if (!server) return fail(server.error());
  app::print_data(fmt::format("{}\n", (*server)->url()));
  console.message("open this address in a browser; it is the only key to the lab. Ctrl+C ends it.");
  (*server)->run();
  return app::ExitCode::done;
}

}  // namespace gnomon::lab
