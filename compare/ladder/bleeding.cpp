#include "compare/ladder/bleeding.h"

#include "compare/ladder/filter_probe.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

constexpr float visible_step = 0.5f / 255.0f;  // half a step of an 8-bit picture

bool shadowed_up_to_bias(const std::array<Image<float>, rung_count>& rungs, std::size_t pixel) {
  for (std::size_t k = 0; k + 1 < rung_count; ++k)
    if (rungs[k].data[pixel] > 0.0f) return false;
  return true;
}

}  // namespace

void BleedingSum::add(const LadderInput& in, const std::array<Image<float>, rung_count>& rungs,
                      const Image<Label>& labels) {
  if (!raster::uses_moments(in.drawn.options.map.technique)) return;
  const auto width = static_cast<std::size_t>(labels.size.width);
  std::vector<BleedingStats> rows(static_cast<std::size_t>(labels.size.height));
  parallel_for(rows.size(), [&](std::size_t y) {
    for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
      const float bled = rungs[6].data[i];
      if (!is_compared(labels.data[i]) || bled < visible_step || !shadowed_up_to_bias(rungs, i)) continue;
      if (lit_within_reach(in, i)) continue;
      ++rows[y].pixels;
      rows[y].mean += bled;
      rows[y].max = std::max(rows[y].max, double{bled});
    }
  });
  for (const Label label : labels.data) compared_ += is_compared(label) ? 1 : 0;
  for (const BleedingStats& row : rows) {
    sums_.pixels += row.pixels;
    sums_.mean += row.mean;
    sums_.max = std::max(sums_.max, row.max);
  }
}

BleedingStats BleedingSum::stats() const {
  BleedingStats out = sums_;
  if (compared_ > 0) out.mean /= static_cast<double>(compared_);
  return out;
}

}  // namespace gnomon::compare
