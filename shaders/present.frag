// An 8-bit sRGB picture on the screen, scaled to the viewport (raster/gl/present.h); row 0 of the texture is the top.
#include "shared_constants.h"

layout(binding = present_unit) uniform sampler2D picture;
layout(location = viewport_uniform) uniform vec4 viewport;  // x, y, width, height in pixels
layout(location = 0) out vec4 color;

void main() {
  vec2 uv = (gl_FragCoord.xy - viewport.xy) / viewport.zw;
  color = vec4(texture(picture, vec2(uv.x, 1.0 - uv.y)).rgb, 1.0);
}
