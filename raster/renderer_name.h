// What the name of an OpenGL renderer says of it.
#pragma once

#include <string_view>

namespace gnomon::raster {

/// Whether a renderer of this name (GL_RENDERER) draws in software.
bool draws_in_software(std::string_view renderer);

}  // namespace gnomon::raster
