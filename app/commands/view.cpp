// gnomon view: the interactive window.
#include "app/view/view.h"

#include <CLI/App.hpp>
#include <memory>

#include "app/invocation.h"
#include "app/options.h"
#include "app/technique_options.h"

namespace gnomon::app {

namespace {

constexpr const char* script_help =
    "drive the window by a file with one step a line: set KEY VALUE, wait N (frames), wait done "
    "(until the comparison is shown), screenshot FILE.png, quit; # starts a comment. Keys: view "
    "(raster, raytrace, difference, labels, depth), size, light, light-azimuth, light-elevation, "
    "camera-orbit (two values), camera-distance, and the options of the shadow map, such as bias and "
    "map-size [default off]";

}  // namespace

void add_view(CLI::App& program, Invocation& invocation) {
  CLI::App* app = program.add_subcommand(
      "view",
      "Turn the camera and the light, change bias and map, and watch the shadows and their differences.");
  app->footer(
      "gnomon view fence                      H prints the keys\n"
      "gnomon view model.glb --size 1600x900 --bias 0.5texel\n"
      "gnomon view floating-box --script tour.txt");
  const auto options = std::make_shared<ViewOptions>();
  add_scene(*app, options->scene);
  add_camera(*app, options->camera);
  add_size(*app, options->compare.raster.size);
  add_tessellate(*app, options->tessellate);
  add_map_options(*app, options->compare.raster.map);
  app->add_option("--light", options->light, "begin with this light [a light's name; default the first]")
      ->type_name("NAME");
  add_shader_dir(*app, options->shader_folder);
  add_pose_options(*app, options->poses);
  add_tracer_options(*app, options->compare.accel, options->compare.precision);
  add_min_contribution(*app, options->compare.raytrace.min_contribution);
  add_exposure(*app, options->exposure);
  app->add_option("--script", options->script, script_help)->type_name("FILE");
  add_threads(*app, options->threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_quiet(*app, options->quiet);
  app->callback([options, &invocation, app] {
    invocation.finish = [options, app] { finish_map_options(*app, options->compare.raster.map); };
    invocation.action = [options] { return run_view(*options); };
  });
}

}  // namespace gnomon::app
