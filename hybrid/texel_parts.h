// Bounds of small parts of a tile's texels, of those alone that an ambiguous receiver has looked up. They lie
// in an open hash table (Knuth, The Art of Computer Programming 3, section 6.4, algorithm L), at most half
// full.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "hybrid/packed_bounds.h"

namespace gnomon::hybrid {

/// A texel that stays ambiguous is looked at in parts_per_side^2 columns: of those, the few that receivers ask
/// for. The smaller they are, the fewer receivers stay ambiguous; but another camera asks for others.
inline constexpr int parts_per_side = 64;
inline constexpr std::uint32_t parts_per_texel = parts_per_side * parts_per_side;

class TexelParts {
 public:
  bool empty() const { return count_ == 0; }
  /// `key`: the texel in its tile times parts_per_texel, and the part, row by row; null where none is known.
  const PackedBounds* find(std::uint32_t key) const {
    std::size_t i = slot(key);
    while (entries_[i].key != key && entries_[i].key != free) i = (i + 1) & mask_;
    return entries_[i].key == key ? &entries_[i].bounds : nullptr;
  }
  /// Where find() will look; of a table that is not empty.
  const void* place(std::uint32_t key) const { return &entries_[slot(key)]; }
  /// The key is new.
  void insert(std::uint32_t key, const PackedBounds& bounds) {
    constexpr std::size_t least = 64;
    if (2 * (count_ + 1) > entries_.size()) {
      const std::vector<Entry> old =
          std::exchange(entries_, std::vector<Entry>(entries_.empty() ? least : 2 * entries_.size()));
      mask_ = entries_.size() - 1;
      for (const Entry& entry : old)
        if (entry.key != free) store(entry);
    }
    store({key, bounds});
    ++count_;
  }
  std::size_t bytes() const { return entries_.size() * sizeof(Entry); }

 private:
  static constexpr std::uint32_t free = 0xffffffffu;
  struct Entry {
    std::uint32_t key = free;
    PackedBounds bounds{};
  };
  std::size_t slot(std::uint32_t key) const { return (key * 0x9e3779b1u >> 7) & mask_; }
  void store(const Entry& entry) {
    std::size_t i = slot(entry.key);
    while (entries_[i].key != free) i = (i + 1) & mask_;
    entries_[i] = entry;
  }

  std::vector<Entry> entries_;
  std::size_t mask_ = 0, count_ = 0;
};

}  // namespace gnomon::hybrid
