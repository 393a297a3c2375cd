// The text of option values beyond numbers: sizes, shares, limits. Errors are ErrorKind::usage
// with a reason that ends in "(got X, allowed Y)".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compare/result/threshold.h"
#include "scene/base/expected.h"
#include "scene/base/option_text.h"
#include "scene/image.h"

namespace gnomon::app {

inline constexpr int max_image_side = 16384;  ///< pixels; OpenGL 4.5 drivers agree on it
/// "1280x720": pixels, each side from 1 to max_image_side; or "720p", one of the sizes that have a name.
Expected<ImageSize> parse_size(std::string_view text);
/// "720p or 1080p or ...; or pixels, 1x1 to 16384x16384": what a size may be, for the help of an option.
std::string size_choices();

/// "1%" or "0.01": a share in [0, 1].
Expected<double> parse_share(std::string_view text);

/// "1%" (a limit of `plain`), "wrong:1%", "mean:0.5%", "flip:0.05", "edge:0.5texel", "shimmer:0.1". A percentage of "1" is refused: it is
/// 100 %, and may be meant as 1 %.
Expected<compare::Threshold> parse_threshold(std::string_view text,
                                             const compare::Figure& plain = compare::wrong_and_mean());

inline constexpr OptionRange exposure_range{0.0, 1e6, true};
/// "auto" (no value) or a linear factor.
Expected<std::optional<double>> parse_exposure(std::string_view text);

}  // namespace gnomon::app
