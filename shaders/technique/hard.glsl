// One comparison with the nearest texel (Williams 1978, "Casting Curved Shadows on Curved Surfaces"): shadowed iff the gap
// exceeds the constant bias.

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  COUNT_LOOKUPS(test.at.inside ? 1 : 0);
  return test.gap > light.bias.x ? 0.0 : 1.0;
}
