// A shape's bounding rectangle in clip space, as a strip of four vertices; the fragment shader casts the rays.
#include "shared_constants.h"

layout(location = rectangle_uniform) uniform vec4 rectangle;  // low and high corner, normalised device coordinates

void main() {
  vec2 corner = mix(rectangle.xy, rectangle.zw, vec2(gl_VertexID & 1, gl_VertexID >> 1));
  gl_Position = vec4(corner, 0.5, 1.0);
}
