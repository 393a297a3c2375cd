// What a depth-comparing texture lookup with linear filtering gives (OpenGL 4.5, section 8.23.1): the comparisons with the
// four nearest texels, weighed bilinearly. Done by hand, since the reference may differ from texel to texel.
#include "taps.glsl"

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  vec2 corner = c.at.uv - 0.5;
  vec2 weight = fract(corner);
  vec4 lit = lit_at_four(c, ivec2(floor(corner)));
  return mix(mix(lit.x, lit.y, weight.x), mix(lit.z, lit.w, weight.x), weight.y);
}
