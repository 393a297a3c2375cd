// Exponential shadow maps (Annen, Mertens, Seidel, Flerackers and Kautz 2008; Salvi 2008): exp(c (z - x)) stands for the
// comparison of a stored z with the receiver's x, so that the mean of exp(c z) is all that is needed.
#include "moment_lookup.glsl"

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  float mean = filtered_moments(test, position, normal);
  return clamp(mean * exp(-light.moments.x * biased_share(test, normal)), 0.0, 1.0);
}
