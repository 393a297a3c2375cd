#include "raster/passes/impostors.h"

namespace gnomon::raster {

Expected<void> draw_impostors(const Gl& gl, ProgramCache& programs, const World& world,
                              const Projection& projection, const LightFace& axes,
                              const ImpostorProgram::Permutation& permutation,
                              const std::function<void(const ImpostorProgram&)>& set) {
  for (std::size_t i = 0; i < world.shapes.size(); ++i) {
    const Shape& shape = world.shapes[i];
    if (!permutation.camera && !world.scene->materials[shape.material].casts_shadow) continue;
    const auto bounds = shape_bounds(projection, shape);
    if (!bounds) continue;
    const auto found = programs.impostor(world, i, permutation);
    if (!found) return fail(found.error());
    const ImpostorProgram& program = **found;
    program.use();
    program.set_shape(static_cast<int>(i), *bounds, shape_in_frame(projection.origin, axes, shape));
    if (is_solid(shape.geometry))
      program.set_solid(solid_from_frame(projection.origin, axes, shape.geometry));
    if (set) set(program);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  return {};
}

}  // namespace gnomon::raster
