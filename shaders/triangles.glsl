// Triangles and their vertices, in buffer textures: these hold more than a storage block, which ends at 128 MB on
// some OpenGLs. Permutation INSTANCES: some of the world's parts are kept instances (scene/world.h), whose vertices are
// those of their mesh; what lies in the world is worked out here, in double precision and in the order of operations of
// scene/world.cpp. Twin of raster/world/world_buffers.cpp.

struct TriangleData {
  uint a, b, c;
  uint material;
  uint part;  // that it belongs to, with INSTANCES
};

layout(binding = triangles_unit) uniform usamplerBuffer triangle_texels;  // the index buffer
layout(binding = triangle_materials_unit) uniform usamplerBuffer triangle_material_texels;
layout(binding = planes_unit) uniform samplerBuffer plane_texels;
layout(binding = positions_unit) uniform samplerBuffer position_texels;
layout(binding = normals_unit) uniform samplerBuffer normal_texels;
layout(binding = uvs_unit) uniform samplerBuffer uv_texels;
#ifdef VERTEX_COLORS
layout(binding = colors_unit) uniform samplerBuffer color_texels;
#endif

// A single texel is every triangle's.
uint triangle_material(uint at) {
  return texelFetch(triangle_material_texels, min(int(at), textureSize(triangle_material_texels) - 1)).x;
}

#ifdef INSTANCES
#include "instances.glsl"

TriangleData triangle_at(uint id) {
  uint part = part_of(id);
  PartData of = part_at(part);
  uint at = of.triangles_at + (id - of.first_triangle), material = triangle_material(at);
  // Indices count from the first vertex of the vertex array that draws the triangle.
  uvec3 t = texelFetch(triangle_texels, int(at)).xyz + (of.kept != 0u ? flat_vertices() : 0u);
  return TriangleData(t.x, t.y, t.z, material == no_material ? of.material : material, part);
}
vec3 position_of(TriangleData t, uint vertex) {
  if (is_kept(t.part)) return relative_position(t.part, vertex);
  return texelFetch(position_texels, int(vertex)).xyz;
}
vec3 normal_of(TriangleData t, uint vertex) {
  vec3 normal = texelFetch(normal_texels, int(vertex)).xyz;
  return is_kept(t.part) ? placed_normal(t.part, normal) : normal;
}
vec4 plane_of(uint id, TriangleData t) {
  if (is_kept(t.part)) return placed_plane(t.part, t.a, t.b, t.c);
  PartData of = part_at(t.part);
  return texelFetch(plane_texels, int(of.triangles_at + (id - of.first_triangle)));
}
#else
TriangleData triangle_at(uint id) {
  uvec3 t = texelFetch(triangle_texels, int(id)).xyz;
  return TriangleData(t.x, t.y, t.z, triangle_material(id), 0u);
}
vec3 position_of(TriangleData t, uint vertex) { return texelFetch(position_texels, int(vertex)).xyz; }
vec3 normal_of(TriangleData t, uint vertex) { return texelFetch(normal_texels, int(vertex)).xyz; }
vec4 plane_of(uint id, TriangleData t) { return texelFetch(plane_texels, int(id)); }  // unit normal, dot(normal, corner)
#endif
vec2 uv_of(uint vertex) { return texelFetch(uv_texels, int(vertex)).xy; }
#ifdef VERTEX_COLORS
vec4 color_of(uint vertex) { return texelFetch(color_texels, int(vertex)); }
#endif
