// Percentage-closer filtering (Reeves, Salesin and Cook 1987, "Rendering Antialiased Shadows with Depth Maps"): the mean of
// the comparisons with BOX_SIZE x BOX_SIZE texels around the receiver's own.
#include "taps.glsl"

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  ivec2 low = ivec2(floor(c.at.uv)) - BOX_SIZE / 2;
  float lit = 0.0;
  for (int row = 0; row < BOX_SIZE; ++row)
    for (int column = 0; column < BOX_SIZE; ++column) lit += lit_at(c, low + ivec2(column, row));
  return lit / float(BOX_SIZE * BOX_SIZE);
}
