// What the shadow lab is asked for, in a window (gnomon view) and in a browser (gnomon serve).
#pragma once

#include <optional>
#include <string>

#include "app/options/pose_options.h"
#include "app/outputs/run_files.h"
#include "app/strongest_lights.h"
#include "compare/compare.h"

namespace CLI {
class App;
}

namespace gnomon::lab {

struct LabOptions {
  app::SceneArgument scene;
  std::string camera;               ///< of the scene's cameras; empty: the first
  std::string light;                ///< name of the light to compare first; empty: the first
  compare::CompareOptions compare;  ///< raster.size is the picture's first size
  raster::Backend backend = raster::Backend::automatic;  ///< of the pictures; a window has the display's own
  std::string shader_folder;                             ///< replacements of shaders/ files; empty: none
  app::PoseOptions poses;
  std::optional<std::optional<double>> exposure;  ///< none: the scene's own
  int threads = 0;                                ///< 0: all cores
  int tessellate = 0;                             ///< sectors; 0: shapes stay exact
  int max_lights = app::usual_max_lights;
  bool quiet = false;
};

/// Adds what a lab begins with: --tessellate, the map's options, --light, the poses, the ray tracer's options, --exposure.
void add_lab_setting(CLI::App& command, LabOptions& options);

}  // namespace gnomon::lab
