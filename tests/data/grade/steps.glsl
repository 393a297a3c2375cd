  vec3 offset = position - light.origin_and_warp[face].xyz;
  vec3 p = vec3(dot(light.right[face].xyz, offset), dot(light.up[face].xyz, offset), dot(light.forward[face].xyz, offset));
  vec2 view = p.xy / light.extent_and_depths[face].xy;
#ifdef PERSPECTIVE
  if (p.z <= 0.0) return 1.0;
  view /= p.z;
#endif
  float size = light.origin_and_size.w;
  vec2 place = (0.5 * view + 0.5) * size;
  if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(size)))) return 1.0;
  ivec3 texel = ivec3(ivec2(floor(place)), face);
  float stored = texelFetch(depth_map, texel, 0).r;
  if (!holds_caster(stored)) return 1.0;
  float gap = p.z - depth_from_stored(texel, stored);
#ifdef PERSPECTIVE
  gap *= length(offset) / p.z;
#endif
  return gap > light.bias.x ? 0.0 : 1.0;
}
