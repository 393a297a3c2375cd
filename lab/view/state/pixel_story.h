// One pixel explained: its ladder, which step made it wrong, and why, in words. Plain data, without a window.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lab/view/state/look.h"
#include "lab/view/work/worker.h"

namespace gnomon::lab {

struct PixelStory {
  PixelPlace pixel;
  compare::Label label = compare::Label::background;
  std::array<double, compare::rung_count> rungs{};  ///< V0 ... V6; 1 lit, 0 in shadow
  compare::Ladder ladder = compare::Ladder::map;
  int deciding = 0;  ///< the rung at which it went wrong, 1 to 6; 0: it is right, or not compared
  double gap = 0.0, distance = 0.0, texel_world = 0.0, bias_world = 0.0;
  double u = 0.0, v = 0.0;  ///< where it looks the map up, texels
  int face = 0;
  bool seen = false;                 ///< a surface is there
  std::string words;                 ///< the story: what the map's test says, and why it is wrong
  std::vector<std::string> remarks;  ///< what the pictures show there beside it: mirrors and glass
  std::string cure;                  ///< what helps; empty where nothing is wrong
};

/// `picture`: the size that the place counts in, which a preview's differs from.
PixelStory tell_story(const ComparisonOutcome& outcome, PixelPlace place, ImageSize picture);

/// A cut through the map at the pixel: stored depths of the texels around its own along u or v, and the receiver's
/// plane. Depths are distances along the light ray, world units.
struct LightCut {
  bool along_v = false;
  int first = 0;                 ///< number of the first texel
  std::vector<double> stored;    ///< of each texel; infinite where nothing is stored
  std::vector<Vec2> receiver;    ///< (texels, distance) along the receiver's own plane
  std::vector<Vec2> neighbours;  ///< the same of pixels around that look up the same row
  double at = 0.0, distance = 0.0;
  double bias = 0.0;  ///< all of it, world units, where it is the same all over the texel; else the constant
};
/// Empty where there is no surface, or the map was not drawn as depths. `texels`: shown on each side.
std::optional<LightCut> cut_through(const ComparisonOutcome& outcome, const PixelStory& story, int texels);

/// The texels around the pixel's own as the light sees them: u grows to the right, v upwards.
struct LightSpace {
  int first_u = 0, first_v = 0;  ///< the lower left texel
  int side = 0;                  ///< texels
  /// How much nearer to the light than the receiver's plane each stores its depth, along the ray through its centre,
  /// world units: row by row from below. Minus infinity: nothing is stored; not a number: beyond the map.
  std::vector<double> nearer;
  double bias =
      0.0;  ///< the constant one: a texel shadows the plane at its centre where it is nearer by more
  double rounding = 0.0;         ///< depths that differ by less are the same to floats, world units
  double u = 0.0, v = 0.0;       ///< the pixel
  std::vector<Vec2> neighbours;  ///< pixels beside it, at most one in each third of a texel
};
/// Empty as above.
std::optional<LightSpace> light_space(const ComparisonOutcome& outcome, const PixelStory& story, int texels);

}  // namespace gnomon::lab
