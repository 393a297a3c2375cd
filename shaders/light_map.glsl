// The light's depth map: which texel a point looks up, and what a stored depth means. Twin of scene/light_view.h.
// Permutations PERSPECTIVE (spot and point lights; else orthographic) and CUBE (six faces).

layout(std140, binding = light_block) uniform Light {
  vec4 right[6];
  vec4 up[6];
  vec4 forward[6];
  vec4 origin_and_size;          // relative to the frame's reference; texels on a side
  vec4 extent_and_depths;        // half extent along right and up; near and far depth
  vec4 bias;                     // constant (world units), slope (multiples), normal offset (texels)
  vec4 direction_and_cos_outer;  // the way the light travels
  vec4 intensity_and_cone;       // w: 1 / (cos inner - cos outer)
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

Texel project_to_texel(vec3 position) {
  Texel t;
  vec3 d = position - light.origin_and_size.xyz;
#ifdef CUBE
  t.face = cube_face(d);
#else
  t.face = 0;
#endif
  t.local = to_face(t.face, d);
#ifdef PERSPECTIVE
  t.distance = length(d);
  float w = t.local.z;
#else
  t.distance = t.local.z;
  float w = 1.0;
#endif
  float size = light.origin_and_size.w;
  t.uv = 0.5 * (t.local.xy / (w * light.extent_and_depths.xy) + 1.0) * size;
  t.inside = w > 0.0 && all(greaterThanEqual(t.uv, vec2(0.0))) && all(lessThan(t.uv, vec2(size)));
  return t;
}

// n f / (f - s (f - n)) for perspective, written so that s near 1 loses nothing: 1 - s is exact there.
float depth_from_stored(float s) {
  float n = light.extent_and_depths.z;
  float f = light.extent_and_depths.w;
#ifdef PERSPECTIVE
  return n * f / (n + (1.0 - s) * (f - n));
#else
  return n + s * (f - n);
#endif
}

float stored_from_depth(float z) {
  float n = light.extent_and_depths.z;
  float f = light.extent_and_depths.w;
#ifdef PERSPECTIVE
  return f * (z - n) / (z * (f - n));
#else
  return (z - n) / (f - n);
#endif
}

// Width along right and up of a whole texel: world units (orthographic), tangents (perspective).
vec2 texel_extent() { return 2.0 * light.extent_and_depths.xy / light.origin_and_size.w; }

// World width of a texel (its wider side) at a depth.
float texel_world_size(float depth) {
  vec2 extent = texel_extent();
#ifdef PERSPECTIVE
  return max(extent.x, extent.y) * depth;
#else
  return max(extent.x, extent.y);
#endif
}
