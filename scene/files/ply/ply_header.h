// The header of a PLY file (Turk 1994): what elements follow, with which properties, in which encoding.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t byte_size(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType length_type = PlyType::uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  int line = 0;  ///< of the header, for messages
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_begin = 0;  ///< the first byte after the header
  std::string texture;         ///< that a comment names, as MeshLab writes it; empty: none does
};

/// Counts are checked against the bytes that follow, so that nothing is allocated for data that cannot be
/// there.
Expected<PlyHeader> read_ply_header(std::string_view bytes, const std::string& file);

}  // namespace gnomon
