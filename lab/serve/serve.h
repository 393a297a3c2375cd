// gnomon serve: what it is asked for, and its entry point.
#pragma once

#include "app/invocation.h"
#include "lab/lab_options.h"
#include "lab/serve/lab_server.h"

namespace gnomon::lab {

struct ServeOptions : LabOptions {
  ServerPlace place;
};

/// Serves the lab's page until the process is ended. Errors: of the scene, of the place.
Expected<app::ExitCode> run_serve(const ServeOptions& options);

}  // namespace gnomon::lab
