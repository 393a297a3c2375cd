// gnomon view: what it is asked for, and its entry point.
#pragma once

#include <string>

#include "app/invocation.h"
#include "lab/lab_options.h"
#include "lab/view/state/look.h"

namespace gnomon::lab {

struct ViewOptions : LabOptions {
  std::string script;  ///< a file of steps that drives the window (script.h); empty: none
  Theme theme = Theme::dark;
  double ui_scale = 1.0;    ///< [least_ui_scale, most_ui_scale], times what the display enlarges by
  bool large_type = false;  ///< for projectors
  bool no_panels = false;   ///< the pictures alone
};

/// Opens the window and returns when it is closed or its script has ended.
Expected<app::ExitCode> run_view(const ViewOptions& options);

}  // namespace gnomon::lab
