// Moment shadow maps with four moments (Peters and Klein 2015, algorithm 3, "Hamburger"): of all distributions with these
// moments, the one that shadows the receiver least. It sits on the receiver's depth and two more, the roots of a quadratic.
#include "moment_lookup.glsl"

// Solves the Hankel matrix of (1, b1, b2, b3, b4) times c = (1, x, x^2) by Cholesky's decomposition L D L^T. D is not
// negative; where it is small, on a filter's texels of one depth, rounding alone could make it so, and a pixel lit.
vec3 solve_hankel(vec4 b, float x) {
  float d2 = max(b.y - b.x * b.x, rounding * b.y);
  float l32 = (b.z - b.x * b.y) / d2;
  float d3 = max(b.w - b.y * b.y - l32 * l32 * d2, rounding * b.w);
  float y2 = x - b.x;
  float y3 = x * x - b.y - l32 * y2;
  vec3 c;
  c.z = y3 / d3;
  c.y = y2 / d2 - l32 * c.z;
  c.x = 1.0 - b.x * c.y - b.y * c.z;
  return c;
}

// The least share that lies before x.
float least_shadow(vec4 b, float x) {
  vec3 c = solve_hankel(b, x);
  float p = c.y / c.z;
  float q = c.x / c.z;
  float root = sqrt(max(0.25 * p * p - q, 0.0));
  float low = -0.5 * p - root;
  float high = -0.5 * p + root;
  if (!(x > low)) return 0.0;
  if (x <= high) return (x * high - b.x * (x + high) + b.y) / ((high - low) * (x - low));
  return 1.0 - (low * high - b.x * (low + high) + b.y) / ((x - low) * (x - high));
}

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  // Rounding can leave moments that no distribution has: a share of one whose moments are safe mends that.
  const vec4 safe = vec4(0.0, 0.375, 0.0, 0.375);
  vec4 b = mix(filtered_moments(test, position, normal), safe, light.moments.z);
  float x = 2.0 * biased_share(test, normal) - 1.0;
  return reduce_bleeding(clamp(1.0 - least_shadow(b, x), 0.0, 1.0));
}
