// Zip files as a test hands them in: stored, not compressed, with any names.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gnomon::app_test {

using PackedFiles = std::vector<std::pair<std::string, std::string>>;  // names and bytes

/// PKWARE's APPNOTE 4.3: each file with its header, then the central directory.
inline std::string zip_of(const PackedFiles& files) {
  const auto number = [](std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
    return text;
  };
  const auto crc_of = [](const std::string& bytes) {
    std::uint32_t crc = ~0u;
    for (const char c : bytes) {
      crc ^= static_cast<unsigned char>(c);
      for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1u ? 0xedb88320u : 0u);
    }
    return ~crc;
  };
  std::string out, directory;
  for (const auto& [name, bytes] : files) {
    const std::string facts = number(10, 2) + number(0, 8) + number(crc_of(bytes), 4) +
                              number(bytes.size(), 4) + number(bytes.size(), 4) + number(name.size(), 2) +
                              number(0, 2);
    directory += "PK\1\2" + number(20, 2) + facts + number(0, 10) + number(out.size(), 4) + name;
    out += "PK\3\4" + facts + name + bytes;
  }
  return out + directory + "PK\5\6" + number(0, 4) + number(files.size(), 2) + number(files.size(), 2) +
         number(directory.size(), 4) + number(out.size(), 4) + number(0, 2);
}

}  // namespace gnomon::app_test
