// gnomon view: the interactive window.
#include "lab/view/view.h"

#include <fmt/core.h>

#include <CLI/App.hpp>
#include <memory>

#include "app/commands.h"
#include "app/invocation.h"
#include "app/options/map_options.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"
#include "app/options/values.h"
#include "app/strongest_lights.h"

namespace gnomon::app {

namespace {

constexpr const char* script_help =
    "drive the window by a file with one step a line: set KEY VALUE, open SCENE, show PRESET, drag X Y X Y, "
    "click X Y, point X Y, drop FILE, key NAME, wait N (frames), wait done (until the comparison is shown), "
    "screenshot FILE.png, save-scene FILE.json, print, quit; # starts a comment; docs/lab.md explains every "
    "step and key [default off]";
constexpr std::pair<std::string_view, lab::Theme> themes[] = {{"dark", lab::Theme::dark},
                                                              {"light", lab::Theme::light}};

void add_look(CLI::App& app, lab::ViewOptions& options) {
  add_choice(app, "--theme", options.theme, themes, "NAME", "colours of the panels");
  add_number(app, "--ui-scale", options.ui_scale, {lab::least_ui_scale, lab::most_ui_scale},
             "times the display's own scale", "size of text and panels");
  app.add_flag("--large-type", options.large_type, "half as large again, for projectors [default off]");
  app.add_flag("--no-panels", options.no_panels,
               "begin with the pictures alone; F11 brings the panels [default off]");
}

void add_window_size(CLI::App& app, ImageSize& size) {
  add_value(app, "--size", "WxH",
            describe("size of the window, panels and all", size_choices(),
                     fmt::format("{}x{}", size.width, size.height)),
            [&size](const std::string& value) { return assign(size, parse_size(value)); });
}

}  // namespace

GNOMON_COMMAND(view, 190,
               "Open the shadow lab, a window: turn the camera and the light, change every setting of the "
               "shadow map, and watch what becomes of the shadows and why.") {
  app->footer(
      "gnomon view fence                      F1 shows the keys\n"
      "gnomon view model.glb --size 1600x900 --bias 0.5texel\n"
      "gnomon view floating-box --script tour.txt");
  const auto options = std::make_shared<lab::ViewOptions>();
  add_scene(*app, options->scene);
  add_scene_time(*app, options->scene);
  add_camera(*app, options->camera);
  add_window_size(*app, options->compare.raster.size);
  lab::add_lab_setting(*app, *options);
  add_look(*app, *options);
  app->add_option("--script", options->script, script_help)->type_name("FILE");
  add_backend(*app, options->backend);
  add_threads(*app, options->threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_quiet(*app, options->quiet);
  app->callback([options, &invocation, app] {
    invocation.finish = [options, app] { finish_map_options(*app, options->compare.raster.map); };
    invocation.action = [options] { return lab::run_view(*options); };
  });
}

}  // namespace gnomon::app
