// The parts of a world that keeps instances, and a kept part's vertices in the world. The arithmetic is that of
// scene/world.h and raster/world_buffers.cpp, operation for operation (precise: none are contracted), so that a kept
// vertex has the very floats that a flattened one has. Twin of raster/part_buffers.cpp.

struct PartData {
  dvec4 column[4];         // of the matrix to the world
  dvec4 normal_column[3];  // of its inverse transpose
  uint first_triangle;     // of the world's
  uint triangles_at;       // where its triangles are in the buffer textures
  uint material;           // of triangles that say none
  uint kept;               // 1: its vertices are in the mesh's own space
};

layout(std430, binding = parts_buffer) readonly buffer Parts {
  dvec4 reference;     // the frame's, in the world
  uint part_count;
  uint flat_vertices;  // before those of meshes that are kept
  PartData parts[];
};
layout(binding = object_positions_unit) uniform usamplerBuffer object_position_texels;  // three doubles a vertex

const uint no_material = 0xffffffffu;

// The part of a triangle.
uint part_of(uint triangle) {
  uint low = 0u, high = part_count;  // in [low, high)
  while (high - low > 1u) {
    uint middle = (low + high) / 2u;
    if (parts[middle].first_triangle <= triangle) low = middle;
    else high = middle;
  }
  return low;
}

bool is_kept(uint part) { return parts[part].kept != 0u; }

dvec3 object_position(uint vertex) {
  int at = 3 * int(vertex - flat_vertices);
  return dvec3(packDouble2x32(texelFetch(object_position_texels, at).xy),
               packDouble2x32(texelFetch(object_position_texels, at + 1).xy),
               packDouble2x32(texelFetch(object_position_texels, at + 2).xy));
}

dvec3 placed_vertex(uint part, uint vertex) {
  dvec3 p = object_position(vertex);
  precise dvec3 first = parts[part].column[0].xyz * p.x + parts[part].column[1].xyz * p.y;
  precise dvec3 second = parts[part].column[2].xyz * p.z + parts[part].column[3].xyz;
  precise dvec3 placed = first + second;
  return placed;
}

vec3 relative_position(uint part, uint vertex) {
  precise dvec3 offset = placed_vertex(part, vertex) - reference.xyz;
  return vec3(offset);
}

// Unit length, or zero.
vec3 placed_normal(uint part, vec3 normal) {
  dvec3 m = dvec3(normal);
  precise dvec3 n = parts[part].normal_column[0].xyz * m.x + parts[part].normal_column[1].xyz * m.y +
                    parts[part].normal_column[2].xyz * m.z;
  precise double squared = n.x * n.x + n.y * n.y + n.z * n.z;
  double size = sqrt(squared);
  return size > 0.0LF ? vec3(n / size) : vec3(0.0);
}

// Unit normal, dot(normal, corner); zero where the triangle has no area.
vec4 placed_plane(uint part, uint va, uint vb, uint vc) {
  dvec3 a = placed_vertex(part, va), b = placed_vertex(part, vb), c = placed_vertex(part, vc);
  precise dvec3 x = b - a, y = c - a, from = a - reference.xyz;
  precise dvec3 n = dvec3(x.y * y.z - y.y * x.z, x.z * y.x - y.z * x.x, x.x * y.y - y.x * x.y);
  precise double squared = n.x * n.x + n.y * n.y + n.z * n.z;
  precise double height = n.x * from.x + n.y * from.y + n.z * from.z;
  double size = sqrt(squared);
  return size > 0.0LF ? vec4(dvec4(n, height) / size) : vec4(0.0);
}
