// Variance shadow maps (Donnelly and Lauritzen 2006): the mean and variance of the depths around bound the share of them
// that lies beyond the receiver.
#include "moment_lookup.glsl"

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  return reduce_bleeding(chebyshev(filtered_moments(test, position, normal), biased_share(test, normal)));
}
