// gnomon serve: the lab as a page, from this program.
#include "lab/serve/serve.h"

#include <CLI/App.hpp>
#include <memory>

#include "app/commands.h"
#include "app/options/option_kinds.h"
#include "app/options/options.h"

namespace gnomon::app {

GNOMON_COMMAND(serve, 180,
               "Serve the shadow lab as a page to a browser on this machine: turn the camera and the light, "
               "change every setting of the shadow map, and watch what becomes of the shadows and why. The "
               "page is at the address that is printed.") {
  app->footer(
      "gnomon serve fence                     open the address that it prints\n"
      "ssh -L 8484:localhost:8484 HOST gnomon serve model.glb --port 8484");
  const auto options = std::make_shared<lab::ServeOptions>();
  options->compare.raster.size = {960, 540};
  add_scene(*app, options->scene);
  add_camera(*app, options->camera);
  add_size(*app, options->compare.raster.size);
  lab::add_lab_setting(*app, *options);
  add_integer(*app, "--port", options->place.port, 0, 65535, "0 is any that is free", "port to listen at");
  app->add_option("--listen", options->place.address,
                  "address to listen at; another than the default lets others on the network try to reach it "
                  "[an address; default 127.0.0.1]")
      ->type_name("ADDRESS")
      ->check([](const std::string& text) {
        return text.empty() ? std::string("an empty address would be all of them; 0.0.0.0 says so")
                            : std::string();
      });
  add_backend(*app, options->backend);
  add_threads(*app, options->threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_quiet(*app, options->quiet);
  app->callback([options, &invocation, app] {
    invocation.finish = [options, app] { finish_map_options(*app, options->compare.raster.map); };
    invocation.action = [options] { return lab::run_serve(*options); };
  });
}

}  // namespace gnomon::app
