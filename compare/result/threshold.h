// What an error may be at most: a measure and its limit, as `compare --fail-above`, `tune --max-error` and
// `sweep --max-error` take it. A measure is a figure whose row has a name for it (figures.h).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::compare {

struct Comparison;
struct Figure;
struct LightFigures;

/// The larger of the share of wrong pixels and the mean error: what a plain number means.
const Figure& wrong_and_mean();
/// The figure that a threshold calls "wrong", "mean", "flip", "edge" or "shimmer"; null where none is called so.
const Figure* find_measure(std::string_view name);

struct Threshold {
  const Figure* measure = &wrong_and_mean();
  double limit = 0.0;  ///< in the measure's unit
  bool operator==(const Threshold&) const = default;
};
/// Writes the threshold as it is given: "1%", "mean:0.5%", "flip:0.05", "edge:0.5texel", "shimmer:0.1".
std::string threshold_text(const Threshold& threshold);
/// "of --measure; without it a share for wrong pixels and mean error both, such as 1%, or wrong:1%, ...": what a threshold may be; of
/// flips where `filmed`.
std::string threshold_range(bool filmed);
/// "at most 1.0 % wrong, and a mean error of at most as much"
std::string limit_words(const Threshold& threshold);

/// What thresholds are held against: the figures of all lights, none where nothing of the scene's file is shown.
std::vector<LightFigures> judged_lights(const Comparison& comparison);
/// "0.26 % wrong, mean error 0.3 %"; of measures that are no percentages what they are too: "mean FLIP 0.0421".
std::string figure_words(const LightFigures& figures, const Figure& measure);

/// Pixels whose truth may be anything, as far as a measure goes: means know the visibility of those that only
/// samples leave open.
std::uint64_t unknown_pixels(const LightFigures& figures, const Figure& measure);
/// So many pixels are uncertain that they alone could exceed the threshold: of those that show a lit or
/// shadowed surface a larger share than the limit; for measures that are no shares, all of them.
bool too_uncertain(const Threshold& threshold, const LightFigures& figures);
/// The figure is more than the limit, or not known.
bool exceeds(const Threshold& threshold, const LightFigures& figures);
/// "0 % wrong, mean error 1.2 %; that is more than --fail-above mean:1%", of figures that exceed it. What is not known exceeds it,
/// too, and is said to. `limit`: the limit as it was given.
std::string excess_words(const Threshold& threshold, const LightFigures& figures, std::string_view limit);
/// No light has a lit or shadowed pixel, not even an uncertain one: the figures say nothing. Of films never.
bool says_nothing(const Threshold& threshold, std::span<const LightFigures> lights);
/// Something was compared, and no light exceeds the threshold or is too uncertain. One of several lights may face away
/// from all that is seen.
bool is_kept(const Threshold& threshold, std::span<const LightFigures> lights);

}  // namespace gnomon::compare
