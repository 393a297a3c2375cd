// One direction of a separable box filter over a layer: the mean of 2 n + 1 texels in a row. At the map's edge the last
// texel repeats.
#include "shared_constants.h"

layout(location = layer_uniform) uniform int layer;
layout(location = step_uniform) uniform ivec2 one_step;
layout(location = blur_radius_uniform) uniform int radius;
layout(binding = moments_unit) uniform sampler2DArray source;
layout(location = 0) out vec4 mean;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(source, 0).xy - 1;
  vec4 sum = vec4(0.0);
  for (int i = -radius; i <= radius; ++i)
    sum += texelFetch(source, ivec3(clamp(here + i * one_step, ivec2(0), last), layer), 0);
  mean = sum / float(2 * radius + 1);
}
