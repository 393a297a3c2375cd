#include "compare/texel_groups.h"

#include <tbb/parallel_sort.h>

namespace gnomon::compare {

using raytrace::TexelKey;

bool texel_of_pixel(const raster::LightRecord& record, std::size_t pixel, TexelKey& key) {
  const Vec2f uv = record.texel_uv.data[pixel];
  const auto size = static_cast<float>(record.map.view.size);
  if (!(uv.x >= 0.0f && uv.y >= 0.0f && uv.x < size && uv.y < size)) return false;
  key = TexelKey::pack(record.face.data[pixel], static_cast<int>(uv.x), static_cast<int>(uv.y));
  return true;
}

TexelGroups group_by_texel(const raster::LightRecord& record, std::span<const std::uint32_t> pixels) {
  struct Entry {
    TexelKey key;
    std::uint32_t pixel;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  entries.reserve(pixels.size());
  for (const std::uint32_t pixel : pixels) {
    Entry entry{{}, pixel};
    if (texel_of_pixel(record, pixel, entry.key)) entries.push_back(entry);
  }
  tbb::parallel_sort(entries);

  TexelGroups groups;
  groups.pixels.reserve(entries.size());
  for (const Entry& entry : entries) {
    if (groups.keys.empty() || groups.keys.back() != entry.key) {
      groups.keys.push_back(entry.key);
      groups.offsets.push_back(static_cast<std::uint32_t>(groups.pixels.size()));
    }
    groups.pixels.push_back(entry.pixel);
  }
  groups.offsets.push_back(static_cast<std::uint32_t>(groups.pixels.size()));
  return groups;
}

}  // namespace gnomon::compare
