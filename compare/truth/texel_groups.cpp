#include "compare/truth/texel_groups.h"

#include <algorithm>

#include "compare/metrics/pixel_list.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {

using raytrace::TexelKey;

bool texel_of_pixel(const raster::LightRecord& record, std::size_t pixel, TexelKey& key) {
  const Vec2f uv = record.texel_uv.data[pixel];
  const auto size = static_cast<float>(record.map.view.size);
  if (!(uv.x >= 0.0f && uv.y >= 0.0f && uv.x < size && uv.y < size)) return false;
  key = TexelKey::pack(record.face.data[pixel], static_cast<int>(uv.x), static_cast<int>(uv.y));
  return true;
}

namespace {

/// A texel and, in the lowest bits, a pixel: one number to sort by. Pictures have up to 2^28 pixels, maps up
/// to 6 faces of 2^16 texels a side.
class Entry {
 public:
  static constexpr int pixel_bits = 28, texel_bits = 35;

  explicit Entry(std::uint64_t packed) : packed_(packed) {}
  Entry(std::uint64_t texel, std::uint32_t pixel) : packed_(texel << pixel_bits | pixel) {}
  std::uint64_t packed() const { return packed_; }
  std::uint64_t texel() const { return packed_ >> pixel_bits; }
  std::uint32_t pixel() const { return static_cast<std::uint32_t>(packed_ & ((1u << pixel_bits) - 1)); }

 private:
  std::uint64_t packed_;
};
constexpr std::uint64_t outside_map = (std::uint64_t{1} << Entry::texel_bits) - 1;  // behind all texels

/// Texels numbered in the order of their keys.
class TexelNumbers {
 public:
  explicit TexelNumbers(int size) : side_(static_cast<std::uint64_t>(size)) {}
  std::uint64_t number(TexelKey key) const {
    return (static_cast<std::uint64_t>(key.face()) * side_ + static_cast<std::uint64_t>(key.row())) * side_ +
           static_cast<std::uint64_t>(key.column());
  }
  TexelKey key(std::uint64_t number) const {
    return TexelKey::pack(static_cast<int>(number / (side_ * side_)), static_cast<int>(number % side_),
                          static_cast<int>(number / side_ % side_));
  }

 private:
  std::uint64_t side_;
};

std::vector<std::uint64_t> sorted_entries(const raster::LightRecord& record,
                                          std::span<const std::uint32_t> pixels, const TexelNumbers& texels) {
  std::vector<std::uint64_t> entries(pixels.size());
  parallel_for(pixels.size(), [&](std::size_t i) {
    TexelKey key;
    const bool inside = texel_of_pixel(record, pixels[i], key);
    entries[i] = Entry(inside ? texels.number(key) : outside_map, pixels[i]).packed();
  });
  sort_numbers(std::span(entries));
  return entries;
}

}  // namespace

TexelGroups group_by_texel(const raster::LightRecord& record, std::span<const std::uint32_t> pixels,
                           std::vector<std::uint32_t>& outside) {
  const TexelNumbers texels(record.map.view.size);
  const std::vector<std::uint64_t> entries = sorted_entries(record, pixels, texels);
  const auto inside = static_cast<std::size_t>(
      std::lower_bound(entries.begin(), entries.end(), Entry(outside_map, 0).packed()) - entries.begin());
  const auto texel = [&](std::size_t i) { return Entry(entries[i]).texel(); };

  TexelGroups groups;
  groups.offsets = pixels_where(inside, [&](std::size_t i) { return i == 0 || texel(i) != texel(i - 1); });
  groups.keys.resize(groups.offsets.size());
  groups.pixels.resize(inside);
  parallel_for(groups.keys.size(),
               [&](std::size_t g) { groups.keys[g] = texels.key(texel(groups.offsets[g])); });
  parallel_for(inside, [&](std::size_t i) { groups.pixels[i] = Entry(entries[i]).pixel(); });
  groups.offsets.push_back(static_cast<std::uint32_t>(inside));
  outside.clear();
  for (std::size_t i = inside; i < entries.size(); ++i) outside.push_back(Entry(entries[i]).pixel());
  return groups;
}

}  // namespace gnomon::compare
