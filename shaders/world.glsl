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

// Texture coordinates of a plane's point (scene.h); a sphere has none.
vec2 shape_uv(ShapeData shape, vec3 position) {
  if (shape.kind != uint(shape_plane)) return vec2(0.0);
  vec3 offset = position - shape.center_and_radius.xyz;
  return vec2(dot(shape.tangent.xyz, offset), dot(shape.bitangent.xyz, offset));
}
