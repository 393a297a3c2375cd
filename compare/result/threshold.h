// What an error may be at most: a measure and its limit, as `compare --fail-above`, `tune --max-error` and
// `sweep --max-error` take it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::compare {

struct Comparison;
struct LightComparison;

enum class ErrorMeasure : std::uint8_t {
  wrong_and_mean,  ///< the larger of the two: what a plain number means
  wrong,           ///< share of wrong pixels
  mean,            ///< mean |V6 - V0|
  flip,            ///< mean FLIP of the visibility pictures
  edge,            ///< RMS displacement of shadow edges, texels
  shimmer          ///< flips per receiver and second of a film (docs/shimmer.md)
};
/// "wrong", "mean", "flip", "edge", "shimmer"; "wrong and mean" for both.
std::string_view measure_name(ErrorMeasure measure);

struct Threshold {
  ErrorMeasure measure = ErrorMeasure::wrong_and_mean;
  double limit = 0.0;     ///< a share in [0, 1]; of `edge` texels, of `shimmer` flips per receiver and second
  bool bare_one = false;  ///< given as "1", which is a share of 100 %, and may be meant as 1 %
  bool operator==(const Threshold&) const = default;
};
/// As it is given: "1%", "mean:0.5%", "flip:0.05", "edge:0.5texel", "shimmer:0.1".
std::string threshold_text(const Threshold& threshold);
/// "at most 1.0 % wrong, and a mean error of at most as much"
std::string limit_words(const Threshold& threshold);

/// What thresholds are held against; NaN where it was not computed.
struct ErrorFigures {
  double wrong_fraction = 0.0, mean_absolute = 0.0;
  double flip = std::numeric_limits<double>::quiet_NaN();
  double edge_rms_texels = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t compared = 0, uncertain = 0;  ///< pixels
  std::uint64_t uncertain_by_samples = 0;     ///< of the uncertain ones: their visibility is known, but not
                                              ///< on which side of one half it lies
  double flips_per_second = std::numeric_limits<double>::quiet_NaN();  ///< per receiver
};
ErrorFigures figures_of(const LightComparison& light);
/// Of all lights, for a threshold: none where nothing of the scene's file is shown.
std::vector<ErrorFigures> figures_of(const Comparison& comparison);
/// The figure that a measure is about.
double figure(const ErrorFigures& figures, ErrorMeasure measure);
/// "0.26 % wrong, mean error 0.3 %"; of flip and edge what they are too: "mean FLIP 0.0421".
std::string figure_words(const ErrorFigures& figures, ErrorMeasure measure);

/// Pixels whose truth may be anything, as far as a measure goes: means know the visibility of those that only
/// samples leave open.
std::uint64_t unknown_pixels(const ErrorFigures& figures, ErrorMeasure measure);
/// So many pixels are uncertain that they alone could exceed the threshold: of those that show a lit or
/// shadowed surface a larger share than the limit; for `edge` and `shimmer`, which are no shares, all of them.
bool too_uncertain(const Threshold& threshold, const ErrorFigures& figures);
/// The figure is more than the limit, or not known.
bool exceeds(const Threshold& threshold, const ErrorFigures& figures);
/// No light has a lit or shadowed pixel, not even an uncertain one: the figures say nothing. Of films (`shimmer`) never.
bool says_nothing(const Threshold& threshold, std::span<const ErrorFigures> lights);
/// Something was compared, and no light exceeds the threshold or is too uncertain. One of several lights may face away
/// from all that is seen.
bool is_kept(const Threshold& threshold, std::span<const ErrorFigures> lights);

}  // namespace gnomon::compare
