// Where everything stands in the window: menu bar above, settings at the left, results at the right, a line of
// words below, and between them the pictures. Pure arithmetic; pixels of the window, (0, 0) at its upper left.
#pragma once

#include <vector>

#include "lab/view/state/look.h"
#include "scene/image.h"

namespace gnomon::lab {

struct Box {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Box&) const = default;
  bool holds(double px, double py) const { return px >= x && py >= y && px < x + width && py < y + height; }
};

/// Sizes of text and of what is around it, pixels.
struct TypeSize {
  double scale = 1.0;
  int font = 15, padding = 4;
  int bar_height() const { return font + 2 * padding; }
};
TypeSize type_size(double scale);

struct LabLayout {
  Box menu, settings, results, status;  ///< of no size where they are not shown
  /// There is no room for two columns: the results share the settings' place, as a tab.
  bool tabs = false;
  Box pictures;            ///< all the panes together
  std::vector<Box> panes;  ///< one, or the four of a square in the order of reading
  ImageSize picture;       ///< pixels that a picture is drawn with: those of the first pane
};

LabLayout lay_out(ImageSize window, const Look& look, const TypeSize& type);

/// Where a picture of this size lies on the window when it is shown in the pane: as large as fits, enlarged
/// and moved by the look. It may be larger than the pane.
Box placed(ImageSize picture, const Box& pane, const Look& look);
/// The whole picture, never enlarged beyond the pane.
Box fitted(ImageSize picture, const Box& pane);

/// A view, the pane that it has the size of, and the part of the pane that shows it.
struct ShownView {
  Picture picture = Picture::raster;
  Box pane, part;
};
/// All that are on the window: one, the two beside a swipe's line, of which `previous` is at the left, or four.
std::vector<ShownView> shown_views(const LabLayout& layout, const Look& look, Picture picture,
                                   Picture previous);
/// Whether it shows the scene as the eye sees it, so that the light's handle has its place there.
bool shows_scene(Picture picture);

}  // namespace gnomon::lab
