// Triangles of the camera's and the light's pass. The same arithmetic in every permutation (invariant), so that the
// analysis pass stores the same depths as the timed one. Permutation ALPHA_MASK hands on texture coordinates, and with
// VERTEX_COLORS the colour's alpha.
#include "shared_constants.h"

layout(location = clip_from_relative_uniform) uniform mat4 clip_from_relative;

layout(location = position_attribute) in vec3 position;
invariant gl_Position;
#ifdef ALPHA_MASK
layout(location = uv_attribute) in vec2 uv;
out vec2 vertex_uv;
#ifdef VERTEX_COLORS
layout(location = color_attribute) in vec4 color;
out float vertex_alpha;
#endif
#endif

void main() {
  gl_Position = clip_from_relative * vec4(position, 1.0);
#ifdef ALPHA_MASK
  vertex_uv = uv;
#ifdef VERTEX_COLORS
  vertex_alpha = color.a;
#endif
#endif
}
