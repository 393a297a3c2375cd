// The depth halfway between the first two surfaces of a texel's ray (Woo 1992), stored as a depth map stores it. Nothing
// behind the first surface counts as the far depth.
#include "shared_constants.h"

layout(location = face_uniform) uniform int face;
layout(binding = depth_map_unit) uniform sampler2DArray first_layer;
layout(binding = second_layer_unit) uniform sampler2DArray second_layer;

#include "light_map.glsl"

layout(location = 0) out float stored;

void main() {
  ivec3 texel = ivec3(gl_FragCoord.xy, face);
  stored = texelFetch(first_layer, texel, 0).r;
  if (!holds_caster(stored)) return;
  float behind = texelFetch(second_layer, texel, 0).r;
  float depth = depth_from_stored(texel, stored);
  float next = holds_caster(behind) ? depth_from_stored(texel, behind) : light.extent_and_depths[face].w;
  stored = stored_from_depth(texel, depth + 0.5 * (next - depth));
}
