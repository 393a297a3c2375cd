// OpenGL 4.5 as raster/ calls it, over WebGL 2. Objects are named directly instead of bound, and buffer textures are
// 2D textures fetch_width wide. The shaders fetch vertices; depth and integers are read back.
#pragma once

#include <memory>
#include <string>

namespace gnomon::web {

/// The function of this name; nullptr where raster/ calls none of it.
void (*gl_procedure(const char* name))();

/// The objects of one context, which has to be current where they are used.
struct State;
std::shared_ptr<State> new_objects();
/// The current context's extensions, enabled; the name of the first without which nothing can be drawn, or nothing.
std::string use_extensions();
/// Says which objects the calls mean: those of the context that is current from now on.
void use_objects(std::shared_ptr<State> of_context);

}  // namespace gnomon::web
