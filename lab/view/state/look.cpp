#include "lab/view/state/look.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/base/option_text.h"

namespace gnomon::lab {

namespace {

constexpr std::array<std::string_view, picture_count> picture_names{
    "raster", "raytrace", "difference", "labels", "truth", "gap", "texels", "depth"};
constexpr std::array<std::string_view, picture_count> picture_titles{
    "Shadow map",  "Ray traced", "Difference",          "Labels",
    "True shadow", "Gap",        "Texels on receivers", "Depth map from the light"};
constexpr std::array<std::string_view, picture_count> picture_legends{
    "",
    "",
    "orange: shadow where light should be; blue: light where shadow should be",
    "white, light grey: rightly lit, rightly in shadow; darker: not compared; colours: wrong",
    "white: lit; black: in shadow; dark grey: not compared",
    "orange: what the map holds is nearer to the light, blue: farther; full colour at 4 texels",
    "each square is a texel; yellow lines: the edges of what the map covers",
    "the brighter, the nearer to the light"};
constexpr std::array<std::string_view, 3> layout_names{"single", "swipe", "quad"};
constexpr std::array<std::string_view, 2> theme_names{"dark", "light"};

template <class Enum, std::size_t count>
Expected<Enum> parse(std::string_view name, const std::array<std::string_view, count>& names,
                     const char* what) {
  for (std::size_t i = 0; i < count; ++i)
    if (names[i] == name) return static_cast<Enum>(i);
  return fail(ErrorKind::usage, fmt::format("no such {} (got {}, allowed {}){}", what, name,
                                            fmt::join(names, ", "), did_you_mean(name, names)));
}

}  // namespace

std::string_view picture_name(Picture picture) {
  return picture_names[static_cast<std::size_t>(picture)];
}
std::string_view picture_title(Picture picture) {
  return picture_titles[static_cast<std::size_t>(picture)];
}
std::string_view picture_legend(Picture picture) {
  return picture_legends[static_cast<std::size_t>(picture)];
}
Expected<Picture> parse_picture(std::string_view name) {
  return parse<Picture>(name, picture_names, "view");
}
Expected<PaneLayout> parse_pane_layout(std::string_view name) {
  return parse<PaneLayout>(name, layout_names, "layout");
}
Expected<Theme> parse_theme(std::string_view name) {
  return parse<Theme>(name, theme_names, "theme");
}

}  // namespace gnomon::lab
