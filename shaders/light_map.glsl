// The light's depth map: which texel a point looks up, and what a stored depth means. Twin of scene/light_map/light_view.h.
// Permutations PERSPECTIVE (spot and point lights; else orthographic), CUBE (six faces; no point falls beside its own).
// Others are CASCADES (several orthographic faces, finest first), WARP (a face warped along up) and REVERSED
// (stored depth is 1 at the near depth and 0 at the far one).

layout(std140, binding = light_block) uniform Light {
  vec4 right[6];
  vec4 up[6];
  vec4 forward[6];
  vec4 origin_and_warp[6];       // of each face, relative to the frame's reference
  vec4 extent_and_depths[6];     // half extent along right and up; near and far depth
  vec4 origin_and_size;          // relative to the frame's reference; texels on a side
  vec4 bias;                     // constant (world units), slope (multiples), normal offset (texels)
  vec4 direction_and_cos_outer;  // the way the light travels
  vec4 intensity_and_cone;       // w: 1 / (cos inner - cos outer)
  vec4 rounding;                 // of floats (world units), of stored depth (a step), epsilon of the adaptive bias;
                                 // texel of the constant bias (TEXEL_BIAS)
  ivec4 counts;                  // faces
  vec4 area_u;                   // a light with size: two vectors from its centre that span it (scene/light_shape/)
  vec4 area_v;
  vec4 filter_radii;             // filter and search radius, texels; bleeding reduction; blended share of a cascade
  vec4 moments;                  // positive and negative exponent, moment bias
} light;

struct Texel {
  vec2 uv;         // map position, texels
  int face;
  vec3 local;      // light-space position: right, up, forward
  float distance;  // along the light ray
  bool inside;
};

// Ties go to x, then y, then z, like cube_face().
int cube_face(vec3 d) {
  vec3 a = abs(d);
  if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0 ? 0 : 1;
  if (a.y >= a.z) return d.y >= 0.0 ? 2 : 3;
  return d.z >= 0.0 ? 4 : 5;
}

vec3 to_face(int face, vec3 v) {
  return vec3(dot(light.right[face].xyz, v), dot(light.up[face].xyz, v), dot(light.forward[face].xyz, v));
}

#ifdef WARP
// Height above the centre of a warped face, from the height that the map shows.
float unwarped(int face, float shown) {
  float warp = light.origin_and_warp[face].w, b = light.extent_and_depths[face].y;
  return (shown - warp * b * b) / (1.0 - warp * shown);
}
float warp_divisor(int face, float y) { return 1.0 + light.origin_and_warp[face].w * y; }
#endif

// `d`: from the face's origin.
Texel project_offset(int face, vec3 d) {
  Texel t;
  t.face = face;
  t.local = to_face(face, d);
#ifdef PERSPECTIVE
  t.distance = length(d);
  float w = t.local.z;
#else
  t.distance = t.local.z;
  float w = 1.0;
#endif
  vec2 shown = t.local.xy;
  vec2 extent = light.extent_and_depths[face].xy;
#ifdef WARP
  w = warp_divisor(face, shown.y);
  shown.y += light.origin_and_warp[face].w * extent.y * extent.y;
#endif
  float size = light.origin_and_size.w;
  t.uv = 0.5 * (shown / (w * extent) + 1.0) * size;
  t.inside = w > 0.0 && all(greaterThanEqual(t.uv, vec2(0.0))) && all(lessThan(t.uv, vec2(size)));
  return t;
}

Texel project_to_face(int face, vec3 position) { return project_offset(face, position - light.origin_and_warp[face].xyz); }

#ifdef CUBE
// A direction from the light need not be unit. It is not added to the light's position, where rounding would turn it by
// an angle that grows with the distance from the reference.
Texel project_direction(vec3 direction) {
  // On an edge of the face rounding may leave it.
  Texel t = project_offset(cube_face(direction), direction);
  if (t.local.z > 0.0) {
    t.uv = clamp(t.uv, vec2(0.0), vec2(light.origin_and_size.w * (1.0 - 6e-8)));  // the last float below size
    t.inside = true;
  }
  return t;
}
#endif

// A point in several cascades belongs to the first that holds it and the four texels around it; those before `first` are
// left out.
Texel project_from_cascade(int first, vec3 position) {
#if defined(CUBE)
  return project_direction(position - light.origin_and_size.xyz);
#elif defined(CASCADES)
  int last = light.counts.x - 1;
  for (int face = first; face < last; ++face) {
    Texel t = project_to_face(face, position);
    if (all(greaterThanEqual(t.uv, vec2(1.0))) && all(lessThan(t.uv, vec2(light.origin_and_size.w - 1.0)))) return t;
  }
  return project_to_face(last, position);
#else
  return project_to_face(0, position);
#endif
}

Texel project_to_texel(vec3 position) { return project_from_cascade(0, position); }

// The share of the stored range that a warped face leaves to the ray at height v (texels).
float warp_share(int face, float v) {
#ifdef WARP
  float b = light.extent_and_depths[face].y;
  float y = unwarped(face, (2.0 * v / light.origin_and_size.w - 1.0) * b);
  return (1.0 - light.origin_and_warp[face].w * b) / warp_divisor(face, y);
#else
  return 1.0;
#endif
}

bool holds_caster(float stored) {
#ifdef REVERSED
  return stored > 0.0;
#else
  return stored < map_clear_depth;
#endif
}

// `texel`: column, row and face of the texel, whose centre's ray the depth lies on.
// n f / (f - s (f - n)) for perspective, written so that s near 1 loses nothing: 1 - s is exact there.
float depth_from_stored(ivec3 texel, float s) {
  float n = light.extent_and_depths[texel.z].z;
  float f = light.extent_and_depths[texel.z].w;
#ifdef PERSPECTIVE
#ifdef REVERSED
  return n * f / (n + s * (f - n));
#else
  return n * f / (n + (1.0 - s) * (f - n));
#endif
#else
  float share = s / warp_share(texel.z, float(texel.y) + 0.5);
#ifdef REVERSED
  return f - share * (f - n);
#else
  return n + share * (f - n);
#endif
#endif
}

// On the ray at height v (texels).
float stored_at(int face, float v, float z) {
  float n = light.extent_and_depths[face].z;
  float f = light.extent_and_depths[face].w;
#ifdef REVERSED
  float from_zero = f - z;
  float one = n;
#else
  float from_zero = z - n;
  float one = f;
#endif
#ifdef PERSPECTIVE
  return one * from_zero / (z * (f - n));
#else
  return from_zero / (f - n) * warp_share(face, v);
#endif
}

float stored_from_depth(ivec3 texel, float z) { return stored_at(texel.z, float(texel.y) + 0.5, z); }

// Width along right and up of a whole texel: world units (orthographic), tangents (perspective). Of a warped face at its
// centre: see texel_step().
vec2 texel_extent(int face) { return 2.0 * light.extent_and_depths[face].xy / light.origin_and_size.w; }

// The way along right and up (at depth 1 of a perspective map) to the ray so many texels away.
vec2 texel_step(Texel at, vec2 offset_texels) {
#ifdef WARP
  vec2 extent = light.extent_and_depths[at.face].xy;
  vec2 shown = (2.0 * (at.uv + offset_texels) / light.origin_and_size.w - 1.0) * extent;
  float y = unwarped(at.face, shown.y);
  return vec2(shown.x * warp_divisor(at.face, y), y) - at.local.xy;
#else
  return offset_texels * texel_extent(at.face);
#endif
}

// World width of the texel (its wider side) where a point falls.
float texel_world_size(Texel at) {
  vec2 extent = texel_extent(at.face);
#if defined(PERSPECTIVE)
  return max(extent.x, extent.y) * at.local.z;
#elif defined(WARP)
  float w = warp_divisor(at.face, at.local.y);
  float sb = light.origin_and_warp[at.face].w * light.extent_and_depths[at.face].y;
  return max(extent.x * w, extent.y * w * w / (1.0 - sb * sb));
#else
  return max(extent.x, extent.y);
#endif
}
