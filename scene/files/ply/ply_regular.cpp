#include "scene/files/ply/ply_regular.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include "scene/base/parallel.h"
#include "scene/files/formats.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

template <class Value>
double as_number(const char* bytes, bool reversed) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), bytes, sizeof(Value));
  if (reversed) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Value>(raw));
}

/// row(i) for all rows, over all threads; false when one of them says so.
template <class Row>
bool all_rows(std::size_t count, const Row& row) {
  constexpr std::size_t at_a_time = 8192;
  std::atomic<bool> good{true};
  parallel_ranges(count, at_a_time, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      if (!row(i)) return good.store(false);
  });
  return good;
}

/// Bytes of a row; 0: rows differ, or the data ends before the last one.
std::size_t row_bytes(std::string_view data, const PlyElement& element) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) return 0;
    bytes += byte_size(property.type);
  }
  return bytes == 0 || element.count > data.size() / bytes ? 0 : bytes;
}

}  // namespace

double ply_number(PlyType type, const char* bytes, bool reversed) {
  switch (type) {
    case PlyType::int8:
      return as_number<std::int8_t>(bytes, reversed);
    case PlyType::uint8:
      return as_number<std::uint8_t>(bytes, reversed);
    case PlyType::int16:
      return as_number<std::int16_t>(bytes, reversed);
    case PlyType::uint16:
      return as_number<std::uint16_t>(bytes, reversed);
    case PlyType::int32:
      return as_number<std::int32_t>(bytes, reversed);
    case PlyType::uint32:
      return as_number<std::uint32_t>(bytes, reversed);
    case PlyType::float32:
      return static_cast<double>(as_number<float>(bytes, reversed));
    case PlyType::float64:
      return as_number<double>(bytes, reversed);
  }
  return 0.0;
}

bool bytes_reversed(PlyEncoding encoding) {
  return (encoding == PlyEncoding::big_endian) != (std::endian::native == std::endian::big);
}

bool is_vertex_number(VertexSlot slot, double value) {
  return std::isfinite(value) && (slot > VertexSlot::z || std::abs(value) <= max_coordinate);
}

void size_vertices(Mesh& mesh, const VertexLayout& layout, std::size_t count) {
  mesh.positions.resize(count);
  if (layout.has_normals) mesh.normals.resize(count);
  if (layout.has_uvs) mesh.uvs.resize(count);
  if (layout.has_colors) mesh.colors.resize(count);
}

void store_vertex(Mesh& mesh, const VertexLayout& layout, std::size_t index, const VertexNumbers& n) {
  mesh.positions[index] = {n[0], n[1], n[2]};
  if (layout.has_normals) mesh.normals[index] = Vec3f(Vec3(n[3], n[4], n[5]));
  if (layout.has_uvs) mesh.uvs[index] = Vec2f(Vec2(n[6], 1.0 - n[7]));
  if (!layout.has_colors) return;
  const auto& scale = layout.color_scale;
  const double alpha = scale[3] > 0.0 ? n[11] / scale[3] : 1.0;
  mesh.colors[index] = linear_color(Vec3f(Vec3(n[8], n[9], n[10]) / Vec3(scale[0], scale[1], scale[2])),
                                    static_cast<float>(alpha));
}

std::size_t read_regular_vertices(std::string_view data, const PlyElement& element, PlyEncoding encoding,
                                  const VertexLayout& layout, Mesh& mesh) {
  const std::size_t bytes = encoding == PlyEncoding::ascii ? 0 : row_bytes(data, element);
  if (bytes == 0) return 0;
  const bool reversed = bytes_reversed(encoding);
  size_vertices(mesh, layout, element.count);
  const bool good = all_rows(element.count, [&](std::size_t i) {
    const char* at = data.data() + i * bytes;
    VertexNumbers numbers{};
    for (std::size_t p = 0; p < layout.slots.size(); ++p) {
      const PlyType type = element.properties[p].type;
      const double value = ply_number(type, at, reversed);
      if (!is_vertex_number(layout.slots[p], value)) return false;
      numbers[static_cast<std::size_t>(layout.slots[p])] = value;
      at += byte_size(type);
    }
    store_vertex(mesh, layout, i, numbers);
    return true;
  });
  if (!good) size_vertices(mesh, layout, 0);
  return good ? bytes * element.count : 0;
}

std::size_t read_regular_faces(std::string_view data, const PlyElement& element, PlyEncoding encoding,
                               Mesh& mesh) {
  constexpr std::size_t bytes = 1 + 3 * sizeof(std::uint32_t);
  if (encoding == PlyEncoding::ascii || bytes_reversed(encoding) || element.properties.size() != 1) return 0;
  const PlyProperty& list = element.properties.front();
  const bool apt = list.is_list && byte_size(list.length_type) == 1 &&
                   (list.type == PlyType::int32 || list.type == PlyType::uint32);
  if (!apt || element.count > data.size() / bytes) return 0;
  mesh.triangles.resize(element.count);
  const bool good = all_rows(element.count, [&](std::size_t i) {
    const char* row = data.data() + i * bytes;
    auto& triangle = mesh.triangles[i];
    std::memcpy(triangle.data(), row + 1, sizeof triangle);
    // A negative index is a large one here.
    return row[0] == 3 && std::max({triangle[0], triangle[1], triangle[2]}) < mesh.positions.size();
  });
  if (!good) mesh.triangles.clear();
  return good ? bytes * element.count : 0;
}

}  // namespace gnomon
