// The parts of a world that keeps instances, and a kept part's vertices in the world. Twin of raster/world/stored_meshes.h.
#include "placed_vertex.glsl"

// What comes first: the frame's reference in the world (a dvec4), the number of parts, and of vertices before those of
// meshes that are kept. Then of each part four columns of the matrix to the world and three of its inverse transpose
// (dvec4), and a PartData.
layout(binding = parts_unit) uniform usamplerBuffer part_texels;

struct PartData {
  uint first_triangle;  // of the world's
  uint triangles_at;    // where its triangles are in the buffer textures
  uint material;        // of triangles that say none
  uint kept;            // 1: its vertices are in the mesh's own space
};

PartData part_at(uint part) {
  uvec4 t = texelFetch(part_texels, parts_header_texel_count + int(part) * part_texel_count + 14);  // after the columns
  return PartData(t.x, t.y, t.z, t.w);
}

dvec3 part_doubles(int at) {
  uvec4 first = texelFetch(part_texels, at);
  return dvec3(packDouble2x32(first.xy), packDouble2x32(first.zw), packDouble2x32(texelFetch(part_texels, at + 1).xy));
}

// 0 ... 3: of the matrix to the world; 4 ... 6: of its inverse transpose.
dvec3 part_column(uint part, int column) {
  return part_doubles(parts_header_texel_count + int(part) * part_texel_count + 2 * column);
}

dvec3 frame_reference() { return part_doubles(0); }
uint part_count() { return texelFetch(part_texels, 2).x; }
uint flat_vertices() { return texelFetch(part_texels, 2).y; }
layout(binding = object_positions_unit) uniform usamplerBuffer object_position_texels;  // three doubles a vertex

const uint no_material = 0xffffffffu;

// The part of a triangle.
uint part_of(uint triangle) {
  uint low = 0u, high = part_count();  // in [low, high)
  while (high - low > 1u) {
    uint middle = (low + high) / 2u;
    if (part_at(middle).first_triangle <= triangle) low = middle;
    else high = middle;
  }
  return low;
}

bool is_kept(uint part) { return part_at(part).kept != 0u; }

dvec3 object_position(uint vertex) {
  int at = 3 * int(vertex - flat_vertices());
  return dvec3(packDouble2x32(texelFetch(object_position_texels, at).xy),
               packDouble2x32(texelFetch(object_position_texels, at + 1).xy),
               packDouble2x32(texelFetch(object_position_texels, at + 2).xy));
}

dvec3 placed_vertex(uint part, uint vertex) {
  return placed_vertex(object_position(vertex), part_column(part, 0), part_column(part, 1), part_column(part, 2),
                       part_column(part, 3));
}

vec3 relative_position(uint part, uint vertex) {
  return relative_vertex(placed_vertex(part, vertex), frame_reference());
}

// Unit length, or zero.
vec3 placed_normal(uint part, vec3 normal) {
  dvec3 m = dvec3(normal);
  precise dvec3 n = part_column(part, 4) * m.x + part_column(part, 5) * m.y +
                    part_column(part, 6) * m.z;
  precise double squared = n.x * n.x + n.y * n.y + n.z * n.z;
  double size = sqrt(squared);
  return size > 0.0LF ? vec3(n / size) : vec3(0.0);
}

// Unit normal, dot(normal, corner); zero where the triangle has no area.
vec4 placed_plane(uint part, uint va, uint vb, uint vc) {
  dvec3 a = placed_vertex(part, va), b = placed_vertex(part, vb), c = placed_vertex(part, vc);
  precise dvec3 x = b - a, y = c - a, from = a - frame_reference();
  precise dvec3 n = dvec3(x.y * y.z - y.y * x.z, x.z * y.x - y.z * x.x, x.x * y.y - y.x * x.y);
  precise double squared = n.x * n.x + n.y * n.y + n.z * n.z;
  precise double height = n.x * from.x + n.y * from.y + n.z * from.z;
  double size = sqrt(squared);
  return size > 0.0LF ? vec4(dvec4(n, height) / size) : vec4(0.0);
}
