// Values that were encoded for a display in place of linear ones. Lit and shadowed are the same in both; only the
// greys of a filter that counts its taps tell: they are whole multiples of one part, 1/9, 1/16, 1/25 ..., in linear
// values alone.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "judge/align.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::judge {
namespace {

constexpr std::size_t few_greys = 100;
constexpr int most_taps = 64;
/// Is how far stored values lie from a multiple: floats and 16 bits lie nearer, 8 bits at half a step.
constexpr float slack = 0.0021f;
/// Decoded nearly all greys lie on multiples, and as they are clearly fewer than that.
constexpr double least_decoded = 0.97, most_as_is = 0.7;

/// How many of the greys are a multiple of 1/taps as the picture writes it, and how many of the multiples there are.
struct OnMultiples {
  double share = 0.0;
  int levels = 0;
};

/// `linear`: the greys without their encoding. `encode`: linear to stored.
template <class Encode>
OnMultiples on_multiples(const std::vector<float>& greys, const std::vector<float>& linear, int taps,
                         const Encode& encode) {
  const auto n = static_cast<float>(taps);
  std::vector<float> stored;
  for (int k = 0; k <= taps; ++k) stored.push_back(encode(static_cast<float>(k) / n));
  std::vector<std::size_t> count(stored.size());
  for (std::size_t i = 0; i < greys.size(); ++i) {
    const auto nearest = static_cast<std::size_t>(std::round(linear[i] * n));
    if (std::abs(greys[i] - stored[nearest]) <= slack) ++count[nearest];
  }
  const auto on = std::accumulate(count.begin(), count.end(), std::size_t{0});
  const auto unseen = std::count(count.begin() + 1, count.end() - 1, std::size_t{0});
  return {static_cast<double>(on) / static_cast<double>(greys.size()), taps - 1 - static_cast<int>(unseen)};
}

/// One grey alone, such as that of a shadow that is never quite dark, is a multiple of some part by chance.
int least_levels(int taps) {
  return std::max(2, (taps + 1) / 3);
}

struct Curve {
  const char* what;
  float (*encode)(float);  ///< linear to stored
  float (*decode)(float);
};
constexpr Curve curves[] = {
    {"the values are sRGB-encoded", srgb_from_linear, linear_from_srgb},
    {"the values are encoded with a gamma of 2.2", [](float v) { return std::pow(v, 1.0f / 2.2f); },
     [](float v) { return std::pow(v, 2.2f); }}};

std::optional<compare::Mended> find_curve(const std::vector<float>& greys, const Curve& curve) {
  std::vector<float> decoded;
  for (const float v : greys) decoded.push_back(curve.decode(v));
  const auto as_is = [&](int taps) { return on_multiples(greys, greys, taps, [](float v) { return v; }); };
  for (int taps = 3; taps <= most_taps; ++taps) {
    const OnMultiples after = on_multiples(greys, decoded, taps, curve.encode);
    if (after.share < least_decoded || after.levels < least_levels(taps)) continue;
    // A right capture would lie on the multiples of some number itself.
    for (int other = 3; other <= taps; ++other)
      if (const auto now = as_is(other); now.share > most_as_is && now.levels >= least_levels(other))
        return std::nullopt;
    return compare::Mended{curve.what, "greys", as_is(taps).share, after.share};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Encoding> find_encoding(const CapturedPictures& pictures,
                                      const raytrace::RayTracedFrame& frame) {
  std::vector<float> greys;
  for (std::size_t i = 0; i < pictures.visibility.data.size(); ++i) {
    const float v = pictures.visibility.data[i];
    if (v < 0.02f || v > 0.99f || frame.receiver.data[i].primitive == no_id || pictures.reached.data[i] == 0)
      continue;
    greys.push_back(v);
  }
  if (greys.size() < few_greys) return std::nullopt;
  for (const Curve& curve : curves)
    if (const auto mended = find_curve(greys, curve)) return Encoding{*mended, curve.decode};
  return std::nullopt;
}

}  // namespace gnomon::judge
