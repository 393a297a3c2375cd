#include "lab/view/window/layout.h"

#include <algorithm>
#include <cmath>

namespace gnomon::lab {

namespace {

constexpr int column_width = 312;              // of a panel at scale 1
constexpr double least_pictures_share = 0.36;  // of the window's width, before the two columns become one
constexpr double most_column_share = 0.5;      // of the window's width
constexpr int seam = 2;                        // between panes

int rounded(double value) {
  return static_cast<int>(std::lround(value));
}

std::vector<Box> four_of(const Box& all) {
  const int width = std::max(1, (all.width - seam) / 2), height = std::max(1, (all.height - seam) / 2);
  std::vector<Box> panes;
  for (const int row : {0, 1})
    for (const int column : {0, 1})
      panes.push_back({all.x + column * (width + seam), all.y + row * (height + seam), width, height});
  return panes;
}

}  // namespace

TypeSize type_size(double scale) {
  return {scale, rounded(15.0 * scale), rounded(4.0 * scale)};
}

LabLayout lay_out(ImageSize window, const Look& look, const TypeSize& type) {
  LabLayout out;
  Box free{0, 0, window.width, window.height};
  const int bar = type.bar_height();
  if (look.panels && window.height > 4 * bar) {
    out.menu = {0, 0, window.width, bar};
    out.status = {0, window.height - bar, window.width, bar};
    free.y = bar, free.height -= 2 * bar;
    const int wanted = (look.settings ? 1 : 0) + (look.results ? 1 : 0);
    const int width = std::min(rounded(column_width * type.scale), rounded(most_column_share * window.width));
    out.tabs = wanted == 2 && window.width - 2 * width < least_pictures_share * window.width;
    if (look.settings || out.tabs) {
      out.settings = {0, free.y, width, free.height};
      free.x += width, free.width -= width;
    }
    if (look.results && !out.tabs) {
      out.results = {window.width - width, free.y, width, free.height};
      free.width -= width;
    }
  }
  out.pictures = free;
  out.panes = look.layout == PaneLayout::quad && free.width > 8 && free.height > 8 ? four_of(free)
                                                                                   : std::vector<Box>{free};
  out.picture = {std::max(1, out.panes.front().width), std::max(1, out.panes.front().height)};
  return out;
}

Box fitted(ImageSize picture, const Box& pane) {
  const double scale = std::min(static_cast<double>(pane.width) / picture.width,
                                static_cast<double>(pane.height) / picture.height);
  const int width = std::max(1, rounded(scale * picture.width));
  const int height = std::max(1, rounded(scale * picture.height));
  return {pane.x + (pane.width - width) / 2, pane.y + (pane.height - height) / 2, width, height};
}

Box placed(ImageSize picture, const Box& pane, const Look& look) {
  const Box whole = fitted(picture, pane);
  if (look.zoom == 1.0) return whole;
  const double width = look.zoom * whole.width, height = look.zoom * whole.height;
  return {rounded(pane.x + 0.5 * pane.width - look.middle.x * width),
          rounded(pane.y + 0.5 * pane.height - look.middle.y * height), rounded(width), rounded(height)};
}

std::vector<ShownView> shown_views(const LabLayout& layout, const Look& look, Picture picture,
                                   Picture previous) {
  std::vector<ShownView> shown;
  if (layout.panes.size() == 4) {
    for (std::size_t i = 0; i < 4; ++i) shown.push_back({look.quad[i], layout.panes[i], layout.panes[i]});
    return shown;
  }
  const Box pane = layout.panes.front();
  if (look.layout != PaneLayout::swipe) return {{picture, pane, pane}};
  Box left = pane, right = pane;
  left.width = rounded(look.swipe * pane.width);
  right.x += left.width, right.width -= left.width;
  return {{previous, pane, left}, {picture, pane, right}};
}

bool shows_scene(Picture picture) {
  return picture == Picture::raster || picture == Picture::raytrace || picture == Picture::texels;
}

}  // namespace gnomon::lab
