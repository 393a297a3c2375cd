// What tests of files have in common: their folder, what a loaded scene notes, and the parts of PNG files.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "scene/scene.h"
#include "tests/support/temporary_folder.h"

namespace gnomon {

using test::TemporaryFolder;

namespace test {

inline bool has_note(const Scene& scene, std::string_view part) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

inline std::string big_endian(std::uint32_t v) {
  return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
          static_cast<char>(v)};
}

inline std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1u ? 0xedb88320u : 0u);
  }
  return ~crc;
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc32(type + data));
}

}  // namespace test
}  // namespace gnomon
