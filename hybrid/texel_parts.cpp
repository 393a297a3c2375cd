#include "hybrid/texel_parts.h"

#include <utility>

namespace gnomon::hybrid {

void TexelParts::insert(std::uint32_t key, const PackedBounds& bounds) {
  constexpr std::size_t least = 64;
  if (2 * (count_ + 1) > entries_.size()) {
    const std::vector<Entry> old =
        std::exchange(entries_, std::vector<Entry>(entries_.empty() ? least : 2 * entries_.size()));
    mask_ = entries_.size() - 1;
    for (const Entry& entry : old)
      if (entry.key != free) put(entry);
  }
  put({key, bounds});
  ++count_;
}

void TexelParts::put(const Entry& entry) {
  std::size_t i = slot(entry.key);
  while (entries_[i].key != free) i = (i + 1) & mask_;
  entries_[i] = entry;
}

}  // namespace gnomon::hybrid
