// One texel of a map as a number, so that a sorted list groups columns.
#pragma once

#include <compare>
#include <cstdint>

namespace gnomon {

struct TexelKey {
  std::uint64_t value = 0;
  static TexelKey pack(int face, int column, int row) {
    return {(static_cast<std::uint64_t>(face) << 56) | (static_cast<std::uint64_t>(row) << 28) |
            static_cast<std::uint64_t>(column)};
  }
  int face() const { return static_cast<int>(value >> 56); }
  int row() const { return static_cast<int>((value >> 28) & 0xfffffff); }
  int column() const { return static_cast<int>(value & 0xfffffff); }
  auto operator<=>(const TexelKey&) const = default;
};

}  // namespace gnomon
