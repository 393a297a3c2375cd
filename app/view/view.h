// gnomon view: what it is asked for, and its entry point.
#pragma once

#include <optional>
#include <string>

#include "app/invocation.h"
#include "app/options/pose_options.h"
#include "app/outputs/run_files.h"
#include "app/strongest_lights.h"
#include "app/view/state/look.h"
#include "compare/compare.h"

namespace gnomon::app {

struct ViewOptions {
  SceneArgument scene;
  std::string camera;               ///< of the scene's cameras; empty: the first
  std::string light;                ///< name of the light to compare first; empty: the first
  compare::CompareOptions compare;  ///< raster.size is the window's first size
  raster::Backend backend =
      raster::Backend::automatic;  ///< of the pictures; the window has the display's own
  std::string shader_folder;       ///< replacements of shaders/ files; empty: none
  PoseOptions poses;
  std::optional<std::optional<double>> exposure;  ///< none: the scene's own
  std::string script;  ///< a file of steps that drives the window (script.h); empty: none
  Theme theme = Theme::dark;
  double ui_scale = 1.0;    ///< [least_ui_scale, most_ui_scale], times what the display enlarges by
  bool large_type = false;  ///< for projectors
  bool no_panels = false;   ///< the pictures alone
  int threads = 0;          ///< 0: all cores
  int tessellate = 0;       ///< sectors; 0: shapes stay exact
  int max_lights = usual_max_lights;
  bool quiet = false;
};

/// Opens the window and returns when it is closed or its script has ended.
Expected<ExitCode> run_view(const ViewOptions& options);

}  // namespace gnomon::app
