// Shadows that were drawn at a fraction of the picture's resolution and enlarged by repeating their pixels: values then
// change between every second (third, fourth) column and row alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "studies/judge/align.h"

namespace gnomon::compare {
namespace {

constexpr int largest_block = 8;
constexpr float least_change = 0.1f;
/// Edges along an axis change the picture at few columns or rows, all of which may be even by chance.
constexpr std::size_t few_borders = 16;
/// Is the least share of the changes; borders of objects may be drawn at the whole resolution.
constexpr double least_share = 0.95;

/// How often the values change between two neighbours, by the coordinate of the second.
struct Changes {
  std::vector<std::uint32_t> columns, rows;
};

Changes count_changes(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame) {
  const Image<float>& v = pictures.visibility;
  Changes out{std::vector<std::uint32_t>(static_cast<std::size_t>(v.size.width)),
              std::vector<std::uint32_t>(static_cast<std::size_t>(v.size.height))};
  const auto tells = [&](std::size_t i) {
    return frame.receiver.data[i].primitive != no_id && pictures.reached.data[i] != 0;
  };
  const auto changes = [&](std::size_t i, std::size_t before) {
    return tells(i) && tells(before) && std::abs(v.data[i] - v.data[before]) > least_change;
  };
  for (int y = 0; y < v.size.height; ++y)
    for (int x = 0; x < v.size.width; ++x) {
      const std::size_t i = v.index(x, y);
      if (x > 0 && changes(i, i - 1)) ++out.columns[static_cast<std::size_t>(x)];
      if (y > 0 && changes(i, v.index(x, y - 1))) ++out.rows[static_cast<std::size_t>(y)];
    }
  return out;
}

/// Whether nearly all changes stand at every `block`-th place, at whichever it starts.
bool stand_apart(const std::vector<std::uint32_t>& changes, std::size_t block) {
  std::array<std::uint64_t, largest_block> at{};
  for (std::size_t i = 0; i < changes.size(); ++i) at[i % block] += changes[i];
  const auto all = std::accumulate(at.begin(), at.end(), std::uint64_t{0});
  const auto places =
      changes.size() - static_cast<std::size_t>(std::count(changes.begin(), changes.end(), 0u));
  return places >= few_borders && static_cast<double>(*std::max_element(at.begin(), at.end())) >=
                                      least_share * static_cast<double>(all);
}

}  // namespace

int shadow_block(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame) {
  const Changes found = count_changes(pictures, frame);
  for (int block = largest_block; block > 1; --block)
    if (stand_apart(found.columns, static_cast<std::size_t>(block)) &&
        stand_apart(found.rows, static_cast<std::size_t>(block)))
      return block;
  return 1;
}

}  // namespace gnomon::compare
