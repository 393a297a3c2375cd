// Triangles and their vertices, in buffer textures: these hold more than a storage block, which ends at 128 MB on
// some OpenGLs. Twin of raster/world_buffers.cpp.

struct TriangleData {
  uint a, b, c;
  uint material;
};

layout(binding = triangles_unit) uniform usamplerBuffer triangle_texels;
layout(binding = planes_unit) uniform samplerBuffer plane_texels;
layout(binding = positions_unit) uniform samplerBuffer position_texels;
layout(binding = normals_unit) uniform samplerBuffer normal_texels;
layout(binding = uvs_unit) uniform samplerBuffer uv_texels;
#ifdef VERTEX_COLORS
layout(binding = colors_unit) uniform samplerBuffer color_texels;
#endif

TriangleData triangle_at(uint id) {
  uvec4 t = texelFetch(triangle_texels, int(id));
  return TriangleData(t.x, t.y, t.z, t.w);
}
vec4 plane_of(uint triangle) { return texelFetch(plane_texels, int(triangle)); }  // unit normal, dot(normal, corner)
vec3 position_of(uint vertex) { return texelFetch(position_texels, int(vertex)).xyz; }
vec3 normal_of(uint vertex) { return texelFetch(normal_texels, int(vertex)).xyz; }
vec2 uv_of(uint vertex) { return texelFetch(uv_texels, int(vertex)).xy; }
#ifdef VERTEX_COLORS
vec4 color_of(uint vertex) { return texelFetch(color_texels, int(vertex)); }
#endif
