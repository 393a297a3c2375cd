// The world's primitives as the shaders see them: triangles 0 ... T-1, then shapes. Everything is relative to the
// frame's reference point. Twin of raster/world/world_buffers.h.
//
// Shapes, like materials and textures, are read through buffer textures. Where pixels of one vector want different
// elements, drivers in software read a storage block one number and one pixel at a time.

struct ShapeData {
  vec4 center_and_radius;  // sphere; or a point of the plane, or a solid's origin (w unused)
  vec4 normal;             // plane, unit; w: dot(normal, point); or a solid's local z axis
  vec4 tangent;            // plane: axes of its texture coordinates; or a solid's local x and y axes
  vec4 bitangent;
  vec4 coefficients;       // quadric: of x^2, y^2, z^2, z; torus: both radii
  vec4 box_min;            // solid, local; w: a quadric's constant
  vec4 box_max;            // w: solid_open, solid_closed, solid_uncut
  uint kind;
  uint material;
  uint primitive;
  uint function;           // implicit: which
};

layout(binding = shapes_unit) uniform usamplerBuffer shape_texels;

vec4 shape_texel(int at) { return uintBitsToFloat(texelFetch(shape_texels, at)); }

ShapeData shape_at(uint index) {
  int at = int(index) * shape_texel_count;
  uvec4 last = texelFetch(shape_texels, at + 7);
  return ShapeData(shape_texel(at), shape_texel(at + 1), shape_texel(at + 2), shape_texel(at + 3), shape_texel(at + 4),
                   shape_texel(at + 5), shape_texel(at + 6), last.x, last.y, last.z, last.w);
}

const float infinite_t = 1e30;
const float half_turn = 3.14159265358979;

vec3 to_solid(ShapeData shape, vec3 v) {
  return vec3(dot(shape.tangent.xyz, v), dot(shape.bitangent.xyz, v), dot(shape.normal.xyz, v));
}
vec3 from_solid(ShapeData shape, vec3 v) {
  return v.x * shape.tangent.xyz + v.y * shape.bitangent.xyz + v.z * shape.normal.xyz;
}

float turn_of(float x, float y) {
  float u = atan(y, x) / (2.0 * half_turn);
  return u < 0.0 ? u + 1.0 : u;
}

// Of a solid's local point (scene/shapes/solid.h).
vec2 solid_uv(ShapeData s, vec3 p) {
  vec3 low = s.box_min.xyz, high = s.box_max.xyz;
  if (s.kind == uint(shape_implicit)) return vec2((p.x - low.x) / (high.x - low.x), (high.y - p.y) / (high.y - low.y));
  if (s.kind == uint(shape_torus)) return vec2(turn_of(p.x, p.y), turn_of(length(p.xy) - s.coefficients.x, p.z));
  if (s.box_max.w == 2.0)  // an ellipsoid
    return vec2(turn_of(p.x / high.x, p.y / high.y), acos(clamp(p.z / high.z, -1.0, 1.0)) / half_turn);
  return vec2(turn_of(p.x, p.y), (high.z - p.z) / (high.z - low.z));
}

// Texture coordinates of a shape's point: along a plane's axes (scene.h); longitude and angle from the top of a sphere.
// Twin of raytrace/shapes/mask_cells.h.
vec2 shape_uv(ShapeData shape, vec3 position) {
  vec3 offset = position - shape.center_and_radius.xyz;
  if (shape.kind == uint(shape_plane)) return vec2(dot(shape.tangent.xyz, offset), dot(shape.bitangent.xyz, offset));
  if (shape.kind >= uint(shape_quadric)) return solid_uv(shape, to_solid(shape, offset));
  vec3 n = normalize(offset);
  return vec2(turn_of(n.x, n.z), acos(clamp(n.y, -1.0, 1.0)) / half_turn);
}
