// sRGB in place of linear values. Lit and shadowed are the same in both; only the greys of a filter that counts
// its taps tell: they are whole multiples of one part, 1/9, 1/16, 1/25 ..., in linear values alone.
#include <algorithm>

#include "compare/judge/align.h"
#include "scene/files/image_io.h"

namespace gnomon::compare {
namespace {

constexpr std::size_t few_greys = 100;
constexpr int most_taps = 64;
/// Floats and 16 bits lie nearer to a multiple, 8 bits at half a step; between 64 taps' parts lie 0.016.
constexpr float slack = 0.0021f;
/// Decoded nearly all greys lie on multiples, and as they are clearly fewer than that.
constexpr double least_decoded = 0.97, most_as_is = 0.7;

double share_on_multiples(const std::vector<float>& greys, int taps) {
  const auto n = static_cast<float>(taps);
  const auto on = std::count_if(greys.begin(), greys.end(),
                                [&](float v) { return std::abs(v - std::round(v * n) / n) <= slack; });
  return static_cast<double>(on) / static_cast<double>(greys.size());
}

}  // namespace

std::optional<Mended> find_srgb(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame) {
  std::vector<float> greys, decoded;
  for (std::size_t i = 0; i < pictures.visibility.data.size(); ++i) {
    const float v = pictures.visibility.data[i];
    if (v < 0.02f || v > 0.99f || frame.receiver.data[i].primitive == no_id || pictures.reached.data[i] == 0)
      continue;
    greys.push_back(v);
    decoded.push_back(linear_from_srgb(v));
  }
  if (greys.size() < few_greys) return std::nullopt;
  for (int taps = 3; taps <= most_taps; ++taps) {
    const double after = share_on_multiples(decoded, taps), before = share_on_multiples(greys, taps);
    if (after < least_decoded) continue;
    // A right capture would lie on the multiples of some number itself.
    for (int other = 3; other <= taps; ++other)
      if (share_on_multiples(greys, other) > most_as_is) return std::nullopt;
    return Mended{"the values are sRGB-encoded", "greys", before, after};
  }
  return std::nullopt;
}

}  // namespace gnomon::compare
