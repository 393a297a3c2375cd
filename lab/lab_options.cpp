#include "lab/lab_options.h"

#include <CLI/App.hpp>

#include "app/options/map_options.h"
#include "app/options/options.h"

namespace gnomon::app {

void add_lab_setting(CLI::App& command, LabOptions& options) {
  add_tessellate(command, options.tessellate);
  add_map_options(command, options.compare.raster.map);
  command.add_option("--light", options.light, "begin with this light [a light's name; default the first]")
      ->type_name("NAME");
  add_max_lights(command, options.max_lights);
  add_shader_dir(command, options.shader_folder);
  add_pose_options(command, options.poses);
  add_tracer_options(command, options.compare.accel, options.compare.precision);
  add_min_contribution(command, options.compare.raytrace.min_contribution);
  add_exposure(command, options.exposure);
}

}  // namespace gnomon::app
