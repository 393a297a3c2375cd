// The text of option values: numbers with their range, sizes, biases, shares. Errors are ErrorKind::usage
// with a reason that ends in "(got X, allowed Y)".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compare/threshold.h"
#include "raster/options.h"
#include "scene/expected.h"
#include "scene/image.h"

namespace gnomon::app {

/// The allowed values of a number, both ends included unless `min_excluded`.
struct OptionRange {
  double min, max;
  bool min_excluded = false;
};
std::string range_text(const OptionRange& range);  ///< "0 to 1000", "above 0 to 1e6"
std::string number_text(double value);             ///< shortest text that reads back as the same number

/// A finite decimal number. NaN and infinities are errors.
Expected<double> parse_number(std::string_view text, const OptionRange& range);
Expected<std::int64_t> parse_integer(std::string_view text, std::int64_t min, std::int64_t max);
/// An unsigned 64-bit integer.
Expected<std::uint64_t> parse_seed(std::string_view text);

inline constexpr int max_image_side = 16384;  ///< pixels; OpenGL 4.5 drivers agree on it
/// "1280x720": pixels, each side from 1 to max_image_side.
Expected<ImageSize> parse_size(std::string_view text);

struct BiasValue {
  double constant = 0.0;
  raster::BiasUnit unit = raster::BiasUnit::world;
};
inline constexpr OptionRange bias_range{-1e30, 1e30};
/// "0.02" (world units along the light ray), "0.5texel" or "auto".
Expected<BiasValue> parse_bias(std::string_view text);
/// Of the constant; an automatic one counts once.
std::string bias_text(const raster::Bias& bias);

/// "1%" or "0.01": a share in [0, 1].
Expected<double> parse_share(std::string_view text);

/// "1%" (wrong and mean error both), "wrong:1%", "mean:0.5%", "flip:0.05", "edge:0.5texel", "shimmer:0.1".
Expected<compare::Threshold> parse_threshold(std::string_view text);
inline constexpr std::string_view threshold_range =
    "a share for wrong pixels and mean error both, such as 1%, or wrong:1%, mean:0.5%, flip:0.05, "
    "edge:0.5texel";
inline constexpr std::string_view film_threshold_range =
    "a share for wrong pixels and mean error both, such as 1%, or wrong:1%, mean:0.5%, flip:0.05, "
    "edge:0.5texel, shimmer:0.1 (flips per receiver and second; includes --metric shimmer)";

inline constexpr OptionRange exposure_range{0.0, 1e6, true};
/// "auto" (no value) or a linear factor.
Expected<std::optional<double>> parse_exposure(std::string_view text);

}  // namespace gnomon::app
