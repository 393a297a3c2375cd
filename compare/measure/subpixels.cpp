#include "compare/measure/subpixels.h"

#include <cmath>

#include "compare/ladder/labels.h"

namespace gnomon::compare {

SubpixelSums::SubpixelSums(ImageSize picture, int side, std::size_t lights)
    : side_(side),
      lights_(lights,
              {Image<float>(picture, 0.0f), Image<std::uint8_t>(picture), Image<std::uint8_t>(picture)}) {}

void SubpixelSums::add(std::size_t light, int first_row, const Climb& climb) {
  Sums& sums = lights_[light];
  const Image<float>&truth = climb.rungs.front(), &drawn = climb.rungs.back();
  for (int y = 0; y < climb.labels.size.height; ++y)
    for (int x = 0; x < climb.labels.size.width; ++x) {
      const std::size_t place = climb.labels.index(x, y),
                        pixel = sums.known.index(x / side_, (first_row + y) / side_);
      const Label label = climb.labels.data[place];
      if (is_compared(label))
        ++sums.known.data[pixel], sums.difference.data[pixel] += drawn.data[place] - truth.data[place];
      else if (label == Label::silhouette || label == Label::uncertain)
        ++sums.unknown.data[pixel];
    }
}

SubpixelFigures SubpixelSums::figures(std::size_t light) const {
  const Sums& sums = lights_[light];
  SubpixelFigures out{.places = side_ * side_};
  std::uint64_t known = 0, unknown = 0, wrong = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < sums.known.data.size(); ++i) {
    unknown += sums.unknown.data[i];
    if (sums.known.data[i] == 0) continue;
    known += sums.known.data[i];
    const double error = std::abs(double{sums.difference.data[i]}) / sums.known.data[i];
    ++out.pixels, sum += error, wrong += error > 0.5 ? 1 : 0;
  }
  if (out.pixels == 0) return out;
  out.mean_absolute = sum / static_cast<double>(out.pixels);
  out.wrong_fraction = static_cast<double>(wrong) / static_cast<double>(out.pixels);
  out.unknown = static_cast<double>(unknown) / static_cast<double>(known + unknown);
  return out;
}

}  // namespace gnomon::compare
