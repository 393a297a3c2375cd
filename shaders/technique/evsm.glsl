// Exponential variance shadow maps (Lauritzen and McCool 2008): Chebyshev's bound for two warps of the depth, the smaller of
// which counts. The receiver's slope reaches the warped variance through the blurred moments themselves.
#include "moment_lookup.glsl"

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  vec4 moments = filtered_moments(test, position, normal);
  vec2 warped = evsm_warp(biased_share(test, normal));
  return reduce_bleeding(min(chebyshev(moments.xy, warped.x), chebyshev(moments.zw, warped.y)));
}
