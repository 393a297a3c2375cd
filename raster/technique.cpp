// The one place that knows every technique by name.
#include "raster/technique_pass.h"
#include "raster/technique_shader.h"

namespace gnomon::raster {

TechniqueShader technique_shader(const MapOptions&, const Light&) {
  return {};
}

std::unique_ptr<TechniquePass> make_technique_pass(Gl&, ProgramCache&, Technique) {
  return nullptr;
}

}  // namespace gnomon::raster
