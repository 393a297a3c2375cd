// Percentage-closer filtering (Reeves, Salesin and Cook 1987, "Rendering Antialiased Shadows with Depth Maps"). The file
// compiles as it stands and compares with one texel; the edge of the shadow shows every texel of the map as a stair.
//
// What is there for you (taps.glsl):
//
//   Comparison c = make_comparison(test, normal)   the receiver and its bias
//   c.at.uv                                        its place in the map, texels from the lower left corner
//   test.at.inside                                 false where the place lies beside the map
//   lit_at(c, texel)                               1.0 where the light passes that texel (ivec2: column, row), else 0.0
//   BOX_SIZE                                       the side of the filter, texels: 3 for --filter-radius 1
#include "taps.glsl"

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  ivec2 own = ivec2(floor(c.at.uv));

  // TODO 1: compare with each of the BOX_SIZE x BOX_SIZE texels around the receiver's own. Which of them is the first?

  // TODO 2: return the mean of the comparisons: not the comparison with a mean of the depths, which is no depth at all.
  return lit_at(c, own);
}
