// The contexts of raster/gl/context.h: none, until shadow maps are drawn by WebGL 2.
#include "raster/gl/context.h"

namespace gnomon::raster {

bool draws_in_software(std::string_view renderer) {
  return renderer.find("SwiftShader") != std::string_view::npos;
}

Expected<std::unique_ptr<Context>> create_context(Backend) {
  return fail(ErrorKind::graphics,
              "this build draws no shadow maps: raytrace, plan, scenes, and judge of a capture with its map "
              "need none");
}

}  // namespace gnomon::raster
