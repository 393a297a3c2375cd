// A face of the depth map turned into moments (moments.glsl). A texel where nothing is stored counts as the far end.
#include "shared_constants.h"
#include "light_map.glsl"
#include "moments.glsl"

layout(location = layer_uniform) uniform int face;
layout(binding = depth_map_unit) uniform sampler2DArray depth_map;
layout(location = 0) out MOMENTS moments;

void main() {
  ivec3 texel = ivec3(ivec2(gl_FragCoord.xy) - MOMENT_BORDER, face);
  float along_ray = 1.0;
#ifdef PERSPECTIVE
  vec2 uv = vec2(texel.xy) + 0.5;
  float size = light.origin_and_size.w;
  vec3 local = vec3((2.0 * uv / size - 1.0) * light.extent_and_depths[face].xy, 1.0);
#ifdef CUBE
  vec3 direction = light.right[face].xyz * local.x + light.up[face].xyz * local.y + light.forward[face].xyz;
  Texel there = project_direction(direction);
  texel = ivec3(clamp(ivec2(floor(there.uv)), ivec2(0), ivec2(int(size) - 1)), there.face);
  local = there.local / there.local.z;
#endif
  along_ray = length(local);
#endif
  float stored = texelFetch(depth_map, texel, 0).r;
  moments = moments_of(holds_caster(stored) ? range_share(depth_from_stored(texel, stored) * along_ray) : 1.0);
}
