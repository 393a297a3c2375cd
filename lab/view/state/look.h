// How the window shows what it has: which views, in which arrangement, how enlarged, in which colours. None of
// it changes what is drawn or compared. Plain data.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "scene/base/expected.h"
#include "scene/math.h"

namespace gnomon::lab {

enum class Picture : std::uint8_t { raster, raytrace, difference, labels, truth, gap, texels, depth };
inline constexpr std::size_t picture_count = 8;
std::string_view picture_name(Picture picture);
/// What people call it: "ray traced".
std::string_view picture_title(Picture picture);
/// What its colours and lines stand for; empty where it is a picture as the eye sees it.
std::string_view picture_legend(Picture picture);
/// Unknown names are ErrorKind::usage, with a suggestion.
Expected<Picture> parse_picture(std::string_view name);

/// One view, two with a line between them, or four.
enum class PaneLayout : std::uint8_t { single, swipe, quad };
Expected<PaneLayout> parse_pane_layout(std::string_view name);

enum class Theme : std::uint8_t { dark, light };
Expected<Theme> parse_theme(std::string_view name);

/// A pixel of the picture, (0, 0) at its upper left.
struct PixelPlace {
  int x = 0, y = 0;
  bool operator==(const PixelPlace&) const = default;
};

inline constexpr double max_picture_zoom = 64.0;
inline constexpr double least_ui_scale = 1.0, most_ui_scale = 3.0;
inline constexpr double large_type_factor = 1.5;  ///< for projectors

struct Look {
  bool panels = true;  ///< off: the pictures alone fill the window
  bool settings = true, results = true;
  bool help = false;  ///< the window of keys
  Theme theme = Theme::dark;
  double ui_scale = 1.0;  ///< times what the display enlarges by; in [least_ui_scale, most_ui_scale]
  bool large_type = false;
  PaneLayout layout = PaneLayout::single;
  std::array<Picture, 4> quad{Picture::raster, Picture::raytrace, Picture::difference, Picture::labels};
  double swipe = 0.5;     ///< where the line stands, share of the pane's width
  double zoom = 1.0;      ///< of the pictures on the screen, in [1, max_picture_zoom]
  Vec2 middle{0.5, 0.5};  ///< the place of the picture in the middle of the pane, shares of its sides
  std::optional<PixelPlace> probe;  ///< the pixel that is explained
  bool operator==(const Look&) const = default;
};

}  // namespace gnomon::lab
