// The contexts of raster/gl/context.h.
#include "raster/gl/context.h"

namespace gnomon::raster {

bool draws_in_software(std::string_view renderer) {
  return renderer.find("SwiftShader") != std::string_view::npos;
}

Expected<std::unique_ptr<Context>> create_context(Backend) {
  return fail(ErrorKind::graphics, "no WebGL 2 here to draw with: raytrace, plan, scenes and judge need none");
}

}  // namespace gnomon::raster
