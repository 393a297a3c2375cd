// Percentage-closer filtering over a disc: FILTER_SAMPLES points of Vogel's spiral, turned by another angle at every pixel.
#include "taps.glsl"
#include "disc_points.glsl"

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  if (!test.at.inside) return 1.0;
  Comparison c = make_comparison(test, normal);
  float turn = pixel_noise();
  float lit = 0.0;
  for (int i = 0; i < FILTER_SAMPLES; ++i) {
    vec2 offset = light.filter_radii.x * disc_point(i, FILTER_SAMPLES, turn);
    lit += lit_at(c, ivec2(floor(c.at.uv + offset)));
  }
  return lit / float(FILTER_SAMPLES);
}
