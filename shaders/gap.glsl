// The gap of the hard shadow test: how far the receiver lies behind what the map stored, along its own light ray. It is in world
// units, less every part of the bias but the constant. Twin of compare/ladder/biased_test.cpp. Permutations SLOPE_BIAS,
// NORMAL_OFFSET (Holbein 2010), RECEIVER_PLANE (Isidoro 2006; less what rounding may do to the plane and the map) and
// ADAPTIVE_BIAS (Dou et al. 2014); TEXEL_BIAS takes the constant, and so the gap, in multiples of the texel looked up.

const float infinite = uintBitsToFloat(0x7f800000u);

// What the technique's visibility takes of the map: texels compared, or filtered reads. Only the records count.
#ifdef RECORDS
int lookups = 0;
#define COUNT_LOOKUPS(n) lookups += n
#else
#define COUNT_LOOKUPS(n)
#endif

layout(binding = depth_map_unit) uniform sampler2DArray depth_map;

// Depth, along forward, at which the light ray offset by (du, dv) texels from `at` meets the plane through it with
// light-space normal n facing the light; +infinity where it does not meet it from the front.
float plane_depth(Texel at, vec3 n, vec2 offset_texels) {
  vec2 step = texel_step(at, offset_texels);
#ifdef PERSPECTIVE
  float here = dot(n, at.local) / at.local.z;  // n . (x, y, 1)
  float there = here + dot(n.xy, step);
  return there < 0.0 ? at.local.z * (here / there) : infinite;
#else
  return n.z < 0.0 ? at.local.z - dot(n.xy, step) / n.z : infinite;
#endif
}

// h_u |dz/du| + h_v |dz/dv| with h half a texel: half the difference of the plane's depths across the texel.
// Infinite for a plane that is edge-on over the texel: then no depth stored there can shadow it.
float texel_depth_slope(Texel at, vec3 n) {
  vec2 low = vec2(plane_depth(at, n, vec2(-0.5, 0.0)), plane_depth(at, n, vec2(0.0, -0.5)));
  vec2 high = vec2(plane_depth(at, n, vec2(0.5, 0.0)), plane_depth(at, n, vec2(0.0, 0.5)));
  if (any(isinf(low)) || any(isinf(high))) return infinite;
  return 0.5 * (abs(high.x - low.x) + abs(high.y - low.y));
}

// What rounding may do to the receiver's plane and to what a texel stores: so much nearer the plane is taken, or it would
// shadow itself.
float plane_rounding(ivec3 texel, float stored) {
  return light.rounding.x + abs(depth_from_stored(texel, stored + light.rounding.y) - depth_from_stored(texel, stored));
}

struct ShadowTest {
  Texel own;     // the receiver's own texel, before any offset
  Texel at;      // where the map is looked up: after the normal offset
  float gap;     // -infinity where nothing is stored, or outside the map
  bool outside;  // the lookup fell outside the map, or beyond its depths where nothing is stored
};

// `normal` is the geometric normal on the viewer's side. Cascades before `first` are left out.
ShadowTest shadow_test_from_cascade(int first, vec3 position, vec3 normal, vec3 to_light) {
  ShadowTest test;
  test.own = project_from_cascade(first, position);
  Texel at = test.own;
#ifdef NORMAL_OFFSET
  float sine = length(cross(normal, to_light));
  at = project_from_cascade(first, position + normal * (light.bias.z * texel_world_size(at) * sine));
#endif
  test.at = at;
  test.gap = -infinite;
  test.outside = !at.inside;
  if (!at.inside) return test;
  ivec3 texel = ivec3(floor(at.uv), at.face);
  float stored = texelFetch(depth_map, texel, 0).r;
  if (!holds_caster(stored)) {
    vec4 range = light.extent_and_depths[at.face];
    test.outside = at.local.z < range.z || at.local.z > range.w;
    return test;
  }
  float receiver = at.local.z;
#ifdef PERSPECTIVE
  float along_ray = at.distance / at.local.z;
#else
  float along_ray = 1.0;
#endif
#if defined(RECEIVER_PLANE) || defined(SLOPE_BIAS) || defined(ADAPTIVE_BIAS)
  vec3 n = to_face(at.face, normal);
#endif
#ifdef RECEIVER_PLANE
  receiver = plane_depth(at, n, vec2(texel.xy) + 0.5 - at.uv) - plane_rounding(texel, stored);
#endif
#ifdef ADAPTIVE_BIAS
  // Where the light ray through the texel's centre meets the receiver's plane before the receiver, the map may hold that.
  receiver -= max(0.0, at.local.z - plane_depth(at, n, vec2(texel.xy) + 0.5 - at.uv)) + light.rounding.z;
#endif
  test.gap = (receiver - depth_from_stored(texel, stored)) * along_ray;
#ifdef SLOPE_BIAS
  test.gap -= light.bias.y * texel_depth_slope(at, n) * along_ray;
#endif
#ifdef TEXEL_BIAS
  test.gap *= light.rounding.w / texel_world_size(at);
#endif
  return test;
}

ShadowTest shadow_test(vec3 position, vec3 normal, vec3 to_light) {
  return shadow_test_from_cascade(0, position, normal, to_light);
}
