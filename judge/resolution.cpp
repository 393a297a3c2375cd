// Shadows that were drawn at a fraction of the picture's resolution and enlarged by repeating their pixels: values then
// change between every second (third, fourth) column and row alone.
#include <algorithm>
#include <cmath>

#include "judge/align.h"

namespace gnomon::judge {
namespace {

constexpr int largest_block = 8;
constexpr float least_change = 0.1f;
/// Edges along an axis change the picture at few columns or rows, all of which may be every second one by chance. Of n that
/// are every b-th one the chance is b^(1 - n), with those of both axes multiplied: it has to be below 2^-30.
constexpr double certain = 30.0;
constexpr std::size_t fewest_borders = 3;  // of each axis
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

/// How many borders the changes stand at; 0 where not nearly all of them do.
template <class IsBorder>
std::size_t borders_with_changes(const std::vector<std::uint32_t>& changes, const IsBorder& is_border) {
  std::uint64_t all = 0, there = 0;
  std::size_t borders = 0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    all += changes[i];
    if (changes[i] > 0 && is_border(i)) there += changes[i], ++borders;
  }
  return static_cast<double>(there) >= least_share * static_cast<double>(all) ? borders : 0;
}

/// Where the changes stand at every `block`-th place, at whichever it starts, how many do. Where the block is no divisor of the
/// picture's side, the smaller picture is stretched over it.
std::size_t borders_of(const std::vector<std::uint32_t>& changes, std::size_t block) {
  std::size_t most = 0;
  const std::size_t side = changes.size();
  for (const std::size_t parts : {side / block, (side + block - 1) / block}) {
    const auto part = [&](std::size_t i) { return (2 * i + 1) * parts / (2 * side); };
    most = std::max(
        most, borders_with_changes(changes, [&](std::size_t i) { return i > 0 && part(i) != part(i - 1); }));
  }
  for (std::size_t phase = 0; phase < block; ++phase)
    most = std::max(most, borders_with_changes(changes, [&](std::size_t i) { return i % block == phase; }));
  return most;
}

}  // namespace

int shadow_block(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame) {
  const Changes found = count_changes(pictures, frame);
  for (int block = largest_block; block > 1; --block) {
    const std::size_t columns = borders_of(found.columns, static_cast<std::size_t>(block)),
                      rows = borders_of(found.rows, static_cast<std::size_t>(block));
    if (std::min(columns, rows) >= fewest_borders &&
        static_cast<double>(columns + rows - 2) * std::log2(block) >= certain)
      return block;
  }
  return 1;
}

}  // namespace gnomon::judge
