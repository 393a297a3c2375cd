// Cascades without seams. Along the border of a cascade its hard test is mixed with that of the next one which holds the
// receiver. It is all of the one where the band begins, and all of the other on the border. Twin of compare/truth/cascades.cpp.

// The next cascade's share, of a receiver at `own`: the band is so wide a share of the face, but for its border of a texel.
float share_of_next(Texel own) {
  if (own.face + 1 >= light.counts.x) return 0.0;
  float size = light.origin_and_size.w;
  vec2 inwards = min(own.uv - 1.0, size - 1.0 - own.uv) / (size - 2.0);
  return clamp(1.0 - min(inwards.x, inwards.y) / light.filter_radii.w, 0.0, 1.0);
}

float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {
  COUNT_LOOKUPS(test.at.inside ? 1 : 0);
  float visibility = test.gap > light.bias.x ? 0.0 : 1.0;
  float share = share_of_next(test.own);
  if (share <= 0.0) return visibility;
  ShadowTest next = shadow_test_from_cascade(test.own.face + 1, position, normal, to_light);
  if (!next.own.inside) return visibility;
  COUNT_LOOKUPS(next.at.inside ? 1 : 0);
  return mix(visibility, next.gap > light.bias.x ? 0.0 : 1.0, share);
}
