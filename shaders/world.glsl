// The world's primitives as the shaders see them: triangles 0 ... T-1, then shapes. Everything is relative to the
// frame's reference point. Twin of raster/world_buffers.h.

struct ShapeData {
  vec4 center_and_radius;  // sphere; or a point of the plane (w unused)
  vec4 normal;             // plane, unit; w: dot(normal, point)
  vec4 tangent;            // plane: axes of its texture coordinates
  vec4 bitangent;
  uint kind;
  uint material;
  uint primitive;
  uint unused;
};

layout(std430, binding = shapes_buffer) readonly buffer Shapes { ShapeData shapes[]; };

// Texture coordinates of a shape's point: along a plane's axes (scene.h); longitude and angle from the top of a sphere.
// Twin of raytrace/surface_uv.h.
vec2 shape_uv(ShapeData shape, vec3 position) {
  vec3 offset = position - shape.center_and_radius.xyz;
  if (shape.kind == uint(shape_plane)) return vec2(dot(shape.tangent.xyz, offset), dot(shape.bitangent.xyz, offset));
  const float pi = 3.14159265358979;
  vec3 n = normalize(offset);
  float u = atan(n.z, n.x) / (2.0 * pi);
  return vec2(u < 0.0 ? u + 1.0 : u, acos(clamp(n.y, -1.0, 1.0)) / pi);
}
