#include "compare/ladder/other_sizes.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"
#include "compare/truth/columns.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

constexpr std::size_t sampled_pixels =
    8192;  // of a whole picture, about: the standard error of 2 % is 0.15 points
constexpr int least_size = 16, most_size = 16384;

/// A texel's share of a filter.
struct Tap {
  int column, row;
  double weight;
};

/// How much of the texel from `first` to first + 1 lies within `radius` of `middle` (shaders/technique/pcf_optimised.glsl).
double overlap(int first, double middle, double radius) {
  return std::clamp(std::min(first + 1.0, middle + radius) - std::max<double>(first, middle - radius), 0.0,
                    1.0);
}

/// The texels within `radius` of a place, each weighed by how much of it the square covers.
std::vector<Tap> square_taps(const TexelCoordinate& at, double radius) {
  const auto low = [&](double x) { return static_cast<int>(std::floor(x - radius)); };
  const auto high = [&](double x) { return static_cast<int>(std::floor(x + radius)); };
  const double area = 4.0 * radius * radius;
  std::vector<Tap> taps;
  for (int row = low(at.v); row <= high(at.v); ++row)
    for (int column = low(at.u); column <= high(at.u); ++column)
      if (const double weight = overlap(column, at.u, radius) * overlap(row, at.v, radius); weight > 0.0)
        taps.push_back({column, row, weight / area});
  return taps;
}

/// (2 n + 1)^2 texels around a place's own.
std::vector<Tap> box_taps(const TexelCoordinate& at, int n) {
  std::vector<Tap> taps;
  const double weight = 1.0 / ((2.0 * n + 1.0) * (2.0 * n + 1.0));
  for (int row = at.row() - n; row <= at.row() + n; ++row)
    for (int column = at.column() - n; column <= at.column() + n; ++column)
      taps.push_back({column, row, weight});
  return taps;
}

std::vector<Tap> taps_at(const raster::MapOptions& map, const TexelCoordinate& at) {
  if (!raster::has_kernel(map.technique)) return {{at.column(), at.row(), 1.0}};
  switch (map.filter.kernel) {
    case raster::FilterKernel::box:
      return box_taps(at, static_cast<int>(map.filter.radius_texels));
    case raster::FilterKernel::hardware:
      return square_taps(at, 0.5);
    default:
      return square_taps(at, map.filter.radius_texels);
  }
}

raster::LightRecord resized(const LadderInput& in, int size) {
  const raster::LightRecord& drawn = in.record();
  raster::LightRecord out;
  out.light = drawn.light;
  out.map.view = drawn.map.view, out.map.format = drawn.map.format;
  out.map.view.size = size;
  out.rounding = drawn.rounding;
  out.rounding.constant_texel_world *= static_cast<double>(drawn.map.view.size) / size;
  out.bias_constant_world =
      raster::constant_bias_world(in.drawn.options.map.bias, out.rounding, out.map.view, in.world());
  return out;
}

/// A depth as the map's format keeps it; none where nothing is stored.
std::optional<double> rounded_depth(const raster::LightRecord& record, int face, double v, double depth) {
  const LightView& view = record.map.view;
  if (depth >= view.face(face).far_depth) return std::nullopt;
  const double step = record.rounding.stored_step;
  const double stored = stored_from_depth(view, face, v, std::max(depth, view.face(face).near_depth));
  return depth_from_stored(view, face, v, step > 0.0 ? std::round(stored / step) * step : stored);
}

/// One pixel of each run of as many as there are for a sample, by a mixed index, so that no pattern of the picture lines
/// up with it.
std::vector<std::uint32_t> sample_of(const LadderInput& in, const Image<Label>& labels,
                                     std::size_t all_pixels) {
  const std::size_t step = std::max<std::size_t>(1, all_pixels / sampled_pixels);
  const std::size_t first = labels.index(0, in.place.first_row);
  std::vector<std::uint32_t> pixels;
  for (std::size_t run = first / step; run * step < first + labels.data.size(); ++run) {
    const std::uint64_t mixed = (run + 1) * 0x9e3779b97f4a7c15ULL;
    const std::size_t pixel = run * step + static_cast<std::size_t>((mixed >> 32U) % step);
    if (pixel < first || pixel >= first + labels.data.size() || !is_compared(labels.data[pixel - first]))
      continue;
    pixels.push_back(static_cast<std::uint32_t>(pixel - first));
  }
  return pixels;
}

}  // namespace

bool other_sizes_apply(const raster::RasterFrame& drawn, const raster::LightRecord& record) {
  const raster::MapOptions& map = drawn.options.map;
  const raster::TechniqueTraits& traits = raster::traits_of(map.technique);
  if (drawn.custom_shader || record.foreign || map.cull != raster::Cull::none) return false;
  if (map.bias.moves_casters()) return false;
  if (traits.contents != raster::MapContents::nearest_depth) return false;
  if (raster::mixes_cascades(map)) return false;
  if (traits.test == raster::ShadowTest::single) return true;
  return raster::has_kernel(map.technique) && map.filter.kernel != raster::FilterKernel::vogel;
}

struct OtherSize::Receiver {
  Vec3 normal;
  BiasedLookup lookup;
  double slack;  ///< the constant bias, world units
};

OtherSize::OtherSize(const LadderInput& input, int size) : in_(input), record_(resized(input, size)) {}

bool OtherSize::is_lit(const Receiver& receiver, int column, int row) const {
  const LightView& view = record_.map.view;
  const int face = receiver.lookup.at.face;
  if (std::min(column, row) < 0 || std::max(column, row) >= view.size) return true;
  BiasedLookup lookup = receiver.lookup;
  lookup.key = raytrace::TexelKey::pack(face, column, row);
  const double depth = trace_centre(in_.tracer, view, face, column, row).depth;
  const auto stored = rounded_depth(record_, face, row + 0.5, depth);
  if (!stored) return true;
  raster::Bias bias = in_.drawn.options.map.bias;
  bias.receiver_plane = bias.receiver_plane || (raster::has_kernel(in_.drawn.options.map.technique) &&
                                                in_.drawn.options.map.filter.receiver_plane);
  return !(gap_before(record_, bias, receiver.normal, lookup, *stored) > receiver.slack);
}

float OtherSize::visibility(std::size_t pixel) const {
  const raytrace::SurfacePoint& point = in_.traced.receiver.data[pixel];
  const LightView& view = record_.map.view;
  const raster::Bias& bias = in_.drawn.options.map.bias;
  Receiver receiver{point.normal, {{}, {}, point.position}, record_.bias_constant_world};
  TexelCoordinate& at = receiver.lookup.at;
  at = project_to_face(view, in_.record().face.data[pixel], point.position);
  if (bias.normal_offset_texels > 0.0) {
    const Vec3 to_light = light_at(in_.light(), point.position).to_light;
    receiver.lookup.position += point.normal * (bias.normal_offset_texels * texel_world_size(view, at) *
                                                glm::length(glm::cross(point.normal, to_light)));
    at = project_to_texel(view, receiver.lookup.position);
  }
  if (!at.inside) return 1.0f;
  double lit = 0.0;
  for (const Tap& tap : taps_at(in_.drawn.options.map, at))
    if (is_lit(receiver, tap.column, tap.row)) lit += tap.weight;
  return static_cast<float>(lit);
}

void OtherSizesSum::add(const LadderInput& in, const Image<float>& truth, const Image<Label>& labels,
                        std::size_t all_pixels) {
  const int drawn_size = in.record().map.view.size;
  if (sizes_.empty())
    for (const int size : {drawn_size / 4, drawn_size / 2, 2 * drawn_size})
      if (size >= least_size && size <= most_size) sizes_.push_back({size});
  const std::vector<std::uint32_t> pixels = sample_of(in, labels, all_pixels);
  count_ += pixels.size();
  for (Size& sum : sizes_) {
    const OtherSize other(in, sum.size);
    std::vector<double> change(pixels.size());
    parallel_for(pixels.size(), [&](std::size_t i) {
      const std::size_t pixel = pixels[i];
      const double right = truth.data[pixel], drawn = in.record().visibility.data[pixel];
      change[i] = std::abs(double(other.visibility(pixel)) - right) - std::abs(drawn - right);
    });
    for (const double c : change) sum.sum += c, sum.squares += c * c;
  }
}

std::vector<OtherMapSize> OtherSizesSum::figures(double drawn_error) const {
  std::vector<OtherMapSize> out;
  if (count_ < 2) return out;
  const auto n = static_cast<double>(count_);
  for (const Size& size : sizes_) {
    const double mean = size.sum / n;
    const double variance = std::max(0.0, size.squares / n - mean * mean);
    out.push_back({size.size, std::clamp(drawn_error + mean, 0.0, 1.0), std::sqrt(variance / (n - 1.0))});
  }
  return out;
}

}  // namespace gnomon::compare
