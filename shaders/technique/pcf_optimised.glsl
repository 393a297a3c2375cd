// A square of side 2 radius around the receiver slides over the map without steps: each texel weighs as much as the
// square overlaps it. Four comparisons come with one lookup, so that PAIRS x PAIRS lookups do (after Castano 2013,
// "Shadow Mapping Summary"). With radius 1/2 this is the bilinear filter.
#include "taps.glsl"

// How much of the texels first and first + 1 the interval [middle - radius, middle + radius] covers.
vec2 overlap(float first, float middle, float radius) {
  vec2 low = vec2(first, first + 1.0);
  return clamp(min(low + 1.0, middle + radius) - max(low, middle - radius), 0.0, 1.0);
}

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  float radius = light.filter_radii.x;
  ivec2 low = ivec2(floor(c.at.uv - radius));
  float lit = 0.0;
  for (int row = 0; row < PAIRS; ++row) {
    vec2 high_weight = overlap(float(low.y + 2 * row), c.at.uv.y, radius);
    for (int column = 0; column < PAIRS; ++column) {
      vec2 weight = overlap(float(low.x + 2 * column), c.at.uv.x, radius);
      vec4 four = lit_at_four(c, low + 2 * ivec2(column, row));
      lit += high_weight.x * dot(weight, four.xy) + high_weight.y * dot(weight, four.zw);
    }
  }
  return lit / (4.0 * radius * radius);
}
