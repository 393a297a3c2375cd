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

// What one comparison compares, as depths along the receiver's own face's forward.
struct Tap {
  float receiver;
  float occluder;  // infinite where nothing is stored
};

// The receiver's depth seen from a texel's centre so many texels away; `texel` and what it stores say how it rounds.
float receiver_depth(Comparison c, vec2 offset_texels, ivec3 texel, float stored) {
#if defined(RECEIVER_PLANE)
  return plane_depth(c.at, c.n, offset_texels) - plane_rounding(texel, stored);
#elif defined(ADAPTIVE_BIAS)
  return c.at.local.z - max(0.0, c.at.local.z - plane_depth(c.at, c.n, offset_texels)) - light.rounding.z;
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

Tap tap_on_face(Comparison c, ivec2 texel, float stored) {
  ivec3 at = ivec3(texel, c.at.face);
  return Tap(receiver_depth(c, vec2(texel) + 0.5 - c.at.uv, at, stored), depth_or_infinite(at, stored));
}

#ifdef CUBE
// The texel of another face that lies in the direction where this face's grid would go on. What it stores lies on the ray
// through its own centre, which is where the receiver's plane must be met as well.
Tap tap_beyond_edge(Comparison c, ivec2 texel) {
  vec2 extent = texel_extent(c.at.face);
  vec2 own = c.at.local.xy / c.at.local.z;
  vec2 tangent = own + (vec2(texel) + 0.5 - c.at.uv) * extent;
  vec3 direction = light.right[c.at.face].xyz * tangent.x + light.up[c.at.face].xyz * tangent.y +
                   light.forward[c.at.face].xyz;
  Texel there = project_direction(direction);
  ivec2 last = ivec2(light.origin_and_size.w) - 1;
  ivec3 at = ivec3(clamp(ivec2(floor(there.uv)), ivec2(0), last), there.face);
  vec2 centre = (2.0 * (vec2(at.xy) + 0.5) / light.origin_and_size.w - 1.0) * light.extent_and_depths[at.z].xy;
  vec3 ray = to_face(c.at.face, light.right[at.z].xyz * centre.x + light.up[at.z].xyz * centre.y +
                                    light.forward[at.z].xyz);
  COUNT_LOOKUPS(1);
  float stored = texelFetch(depth_map, at, 0).r;
  return Tap(receiver_depth(c, (ray.xy / ray.z - own) / extent, at, stored), depth_or_infinite(at, stored) * ray.z);
}
#endif

Tap tap_at(Comparison c, ivec2 texel) {
  if (on_face(texel)) {
    COUNT_LOOKUPS(1);
    return tap_on_face(c, texel, texelFetch(depth_map, ivec3(texel, c.at.face), 0).r);
  }
#ifdef CUBE
  return tap_beyond_edge(c, texel);
#else
  return Tap(c.at.local.z, infinite);
#endif
}

bool shadows(Comparison c, Tap tap) {
  return !isinf(tap.occluder) && (tap.receiver - tap.occluder) * c.along_ray > c.slack;
}

float lit_by(Comparison c, Tap tap) { return shadows(c, tap) ? 0.0 : 1.0; }
float lit_at(Comparison c, ivec2 texel) { return lit_by(c, tap_at(c, texel)); }

// Four texels at once: (0,0), (1,0), (0,1), (1,1) from `low`.
vec4 lit_at_four(Comparison c, ivec2 low) {
  const ivec2 right = ivec2(1, 0), up = ivec2(0, 1);
  if (!on_face(low) || !on_face(low + 1))
    return vec4(lit_at(c, low), lit_at(c, low + right), lit_at(c, low + up), lit_at(c, low + 1));
  vec2 corner = vec2(low + 1) / light.origin_and_size.w;
  COUNT_LOOKUPS(4);
  vec4 stored = textureGather(depth_map, vec3(corner, c.at.face)).wzxy;
  return vec4(lit_by(c, tap_on_face(c, low, stored.x)), lit_by(c, tap_on_face(c, low + right, stored.y)),
              lit_by(c, tap_on_face(c, low + up, stored.z)), lit_by(c, tap_on_face(c, low + 1, stored.w)));
}
