// Binary PLY data whose rows are all alike, read many rows at a time: vertices without lists, faces that are
// all triangles. Whatever is out of the ordinary, faults included, is left to the general reader (ply.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scene/files/ply/ply_header.h"
#include "scene/scene.h"

namespace gnomon {

/// Which number of a vertex goes where.
enum class VertexSlot : std::uint8_t { x, y, z, nx, ny, nz, u, v, red, green, blue, alpha, other };
inline constexpr std::size_t vertex_slots = 13;

struct VertexLayout {
  std::vector<VertexSlot> slots;  ///< one for each property
  bool has_normals = false, has_uvs = false, has_colors = false;
  std::array<double, 4> color_scale{1.0, 1.0, 1.0, 1.0};  ///< what 1 is stored as; alpha: 0 for none
};

/// A number in binary data; `reversed`: its bytes are in the other order than the machine's.
double ply_number(PlyType type, const char* bytes, bool reversed);
bool bytes_reversed(PlyEncoding encoding);

/// Whether the general reader takes the number: finite, and a position's not too large.
bool is_vertex_number(VertexSlot slot, double value);

/// A vertex whose numbers have been read, by slot.
using VertexNumbers = std::array<double, vertex_slots>;
/// Puts it into arrays that are long enough.
void store_vertex(Mesh& mesh, const VertexLayout& layout, std::size_t index, const VertexNumbers& numbers);
/// Makes them so.
void size_vertices(Mesh& mesh, const VertexLayout& layout, std::size_t count);

/// Reads all vertices; the bytes that they take, or 0 and an empty mesh when the data is not binary, ends
/// before, or holds a list or a number that is not taken.
std::size_t read_regular_vertices(std::string_view data, const PlyElement& element, PlyEncoding encoding,
                                  const VertexLayout& layout, Mesh& mesh);

/// Reads all faces of a mesh that has its vertices, and returns the bytes that they take. Each row must be a
/// byte that says 3 and three indices of 32 bits in the machine's order of bytes. When rows are anything
/// else, or one is not a triangle of these vertices, returns 0 and no triangles.
std::size_t read_regular_faces(std::string_view data, const PlyElement& element, PlyEncoding encoding,
                               Mesh& mesh);

}  // namespace gnomon
