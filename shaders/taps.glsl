// Comparisons of one receiver with many texels, for the techniques that average them. Each is the hard test's (gap.glsl)
// with the same bias; with RECEIVER_PLANE the receiver's depth is its plane's at the centre of the texel compared
// with. Beyond the edge of a cube's face the texel is the one in the same direction on the next face, elsewhere there
// is nothing that could shadow.

struct Comparison {
  Texel at;         // the receiver's place in the map
  vec3 n;           // its normal, in the face's frame
  float slack;      // the gap that still counts as lit: constant and slope bias, world units along the light ray
  float along_ray;  // world units along the light ray per unit of depth
};

Comparison make_comparison(ShadowTest test, vec3 normal) {
  Comparison c;
  c.at = test.at;
  c.n = to_face(c.at.face, normal);
#ifdef PERSPECTIVE
  c.along_ray = c.at.distance / c.at.local.z;
#else
  c.along_ray = 1.0;
#endif
  c.slack = light.bias.x;
#ifdef SLOPE_BIAS
  c.slack += light.bias.y * texel_depth_slope(c.at, c.n) * c.along_ray;
#endif
  return c;
}

float receiver_depth(Comparison c, ivec2 texel) {
#ifdef RECEIVER_PLANE
  return plane_depth(c.at, c.n, vec2(texel) + 0.5 - c.at.uv);
#else
  return c.at.local.z;
#endif
}

bool on_face(ivec2 texel) {
  return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(light.origin_and_size.w)));
}

float depth_or_infinite(ivec3 texel, float stored) {
  return holds_caster(stored) ? depth_from_stored(texel, stored) : infinite;
}

#ifdef CUBE
// Along the receiver's own face's forward, of what another face stores in the texel's direction.
float depth_beyond_edge(Comparison c, ivec2 texel) {
  vec2 tangent = c.at.local.xy / c.at.local.z + texel_step(c.at, vec2(texel) + 0.5 - c.at.uv);
  vec3 direction = light.right[c.at.face].xyz * tangent.x + light.up[c.at.face].xyz * tangent.y +
                   light.forward[c.at.face].xyz;
  Texel there = project_to_texel(light.origin_and_size.xyz + direction);
  ivec2 last = ivec2(light.origin_and_size.w) - 1;
  ivec3 at = ivec3(clamp(ivec2(floor(there.uv)), ivec2(0), last), there.face);
  return depth_or_infinite(at, texelFetch(depth_map, at, 0).r) / there.local.z;
}
#endif

// Depth of what is stored in a texel, which may lie beyond the face's edge.
float occluder_depth(Comparison c, ivec2 texel) {
  ivec3 at = ivec3(texel, c.at.face);
  if (on_face(texel)) return depth_or_infinite(at, texelFetch(depth_map, at, 0).r);
#ifdef CUBE
  return depth_beyond_edge(c, texel);
#else
  return infinite;
#endif
}

bool shadows(Comparison c, float receiver, float occluder) {
  return !isinf(occluder) && (receiver - occluder) * c.along_ray > c.slack;
}

float lit_at(Comparison c, ivec2 texel) {
  return shadows(c, receiver_depth(c, texel), occluder_depth(c, texel)) ? 0.0 : 1.0;
}

float lit_by(Comparison c, ivec2 texel, float stored) {
  return shadows(c, receiver_depth(c, texel), depth_or_infinite(ivec3(texel, c.at.face), stored)) ? 0.0 : 1.0;
}

// Four texels at once: (0,0), (1,0), (0,1), (1,1) from `low`.
vec4 lit_at_four(Comparison c, ivec2 low) {
  const ivec2 right = ivec2(1, 0), up = ivec2(0, 1);
  if (!on_face(low) || !on_face(low + 1))
    return vec4(lit_at(c, low), lit_at(c, low + right), lit_at(c, low + up), lit_at(c, low + 1));
  vec2 corner = vec2(low + 1) / light.origin_and_size.w;
  vec4 stored = textureGather(depth_map, vec3(corner, c.at.face)).wzxy;
  vec4 lit;
  lit.x = lit_by(c, low, stored.x);
  lit.y = lit_by(c, low + right, stored.y);
  lit.z = lit_by(c, low + up, stored.z);
  lit.w = lit_by(c, low + 1, stored.w);
  return lit;
}
