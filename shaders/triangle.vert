// Triangles of the camera's and the light's pass. The same arithmetic in every permutation (invariant), so that the
// analysis pass stores the same depths as the timed one. Permutation ALPHA_MASK hands on texture coordinates, and with
// VERTEX_COLORS the colour's alpha; KEPT draws a kept instance, whose vertices are those of its mesh.
#include "shared_constants.h"

layout(location = clip_from_relative_uniform) uniform mat4 clip_from_relative;

invariant gl_Position;
#ifdef KEPT
#include "triangles.glsl"
layout(location = part_uniform) uniform uint part;
#else
layout(location = position_attribute) in vec3 position;
#endif
#ifdef ALPHA_MASK
#ifndef KEPT
layout(location = uv_attribute) in vec2 uv;
#endif
out vec2 vertex_uv;
#ifdef VERTEX_COLORS
#ifndef KEPT
layout(location = color_attribute) in vec4 color;
#endif
out float vertex_alpha;
#endif
#endif

void main() {
#ifdef KEPT
  vec3 position = relative_position(part, uint(gl_VertexID));
#ifdef ALPHA_MASK
  vec2 uv = uv_of(uint(gl_VertexID));
#ifdef VERTEX_COLORS
  vec4 color = color_of(uint(gl_VertexID));
#endif
#endif
#endif
  gl_Position = clip_from_relative * vec4(position, 1.0);
#ifdef ALPHA_MASK
  vertex_uv = uv;
#ifdef VERTEX_COLORS
  vertex_alpha = color.a;
#endif
#endif
}
