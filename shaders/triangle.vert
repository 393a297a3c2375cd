// Triangles of the camera's and the light's pass. The same arithmetic in every permutation (invariant), so that the
// analysis pass stores the same depths as the timed one. Permutation ALPHA_MASK hands on texture coordinates, and with
// VERTEX_COLORS the colour's alpha; KEPT draws a kept instance, whose vertices are those of its mesh.
#include "shared_constants.h"

layout(location = clip_from_relative_uniform) uniform mat4 clip_from_relative;

invariant gl_Position;
#ifdef KEPT
#include "placed_vertex.glsl"
layout(location = part_columns_uniform) uniform dvec3 part_columns[4];  // of the matrix to the world
layout(location = reference_uniform) uniform dvec3 reference;
layout(location = position_attribute) in dvec3 object_position;
#else
layout(location = position_attribute) in vec3 position;
#endif
#ifdef ALPHA_MASK
layout(location = uv_attribute) in vec2 uv;
out vec2 vertex_uv;
#ifdef VERTEX_COLORS
layout(location = color_attribute) in vec4 color;
out float vertex_alpha;
#endif
#endif

void main() {
#ifdef KEPT
  dvec3 placed =
      placed_vertex(object_position, part_columns[0], part_columns[1], part_columns[2], part_columns[3]);
  vec3 position = relative_vertex(placed, reference);
#endif
  gl_Position = clip_from_relative * vec4(position, 1.0);
#ifdef ALPHA_MASK
  vertex_uv = uv;
#ifdef VERTEX_COLORS
  vertex_alpha = color.a;
#endif
#endif
}
