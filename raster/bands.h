// Pictures drawn some rows at a time, for those whose images would not all fit into memory at one time. What the
// camera sees is drawn once, for the whole picture, so that each triangle covers the very pixels that it covers
// otherwise; shading, records and lists of pixels are made for the rows alone.
#pragma once

#include <memory>
#include <optional>

#include "raster/external_visibility.h"
#include "raster/renderer.h"
#include "scene/image.h"

namespace gnomon::raster {

/// From the next frame on render() makes these rows of the picture of RasterOptions::size. They are to the last
/// bit as in the whole (of hybrid the pictures, not who decided each pixel). Row 0 of a frame's images is
/// rows->first. Nothing: whole pictures. Bands of one picture come from top to bottom, with the same options,
/// lights and scene; what the first of them has drawn is kept for the others, and maps are timed by it alone. The
/// renderer is one that Renderer::create made.
void set_rows(Renderer& renderer, const std::optional<PictureRows>& rows);

/// Whether technique and options keep lists of pixels in blocks of limited size; then no band may have more pixels
/// than this. 0: no limit.
std::size_t most_pixels(const Renderer& renderer, const MapOptions& map);

/// An ExternalVisibility that can be asked for some rows.
class ExternalRows {
 public:
  virtual ~ExternalRows() = default;
  /// Which row of the camera's picture row 0 of the following images is.
  virtual void set_first_row(int row) = 0;
};

/// Costs and times of the band after those of the bands before it, whose images and maps stay as they are.
void add_costs(const RasterFrame& band, RasterFrame& sum);

}  // namespace gnomon::raster
