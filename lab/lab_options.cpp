#include "lab/lab_options.h"

#include <CLI/App.hpp>

#include "app/options/map_options.h"
#include "app/options/options.h"

namespace gnomon::lab {

void add_lab_setting(CLI::App& command, LabOptions& options) {
  app::add_tessellate(command, options.tessellate);
  app::add_map_options(command, options.compare.raster.map);
  command.add_option("--light", options.light, "begin with this light [a light's name; default the first]")
      ->type_name("NAME");
  app::add_max_lights(command, options.max_lights);
  app::add_shader_dir(command, options.shader_folder);
  app::add_pose_options(command, options.poses);
  app::add_tracer_options(command, options.compare.accel, options.compare.precision);
  app::add_min_contribution(command, options.compare.raytrace.min_contribution);
  app::add_exposure(command, options.exposure);
}

}  // namespace gnomon::lab
