// Images of some pixels of a picture: those whose row and column are multiples of a step.
#pragma once

#include "compare/comparison.h"

namespace gnomon::compare {

struct Reduction {
  int step = 1;
  int height = 0;  ///< of the whole picture, pixels
};

/// The page shows every step-th pixel of every step-th row of a picture with more pixels than it can hold: 1 up to 8
/// million pixels.
int image_step(const ImageSize& picture);
/// The comparison with the images of those pixels alone; `comparison` has all.
Comparison reduced_images(const Comparison& comparison, int step);

/// Puts what a step leaves of these rows, the first of which is first_row of the picture, under what is there.
template <class T>
void append_reduced(Image<T>& to, const Image<T>& rows, int first_row, const Reduction& reduction) {
  if (rows.data.empty()) return;
  const int step = reduction.step;
  to.size.width = (rows.size.width + step - 1) / step;
  if (to.data.empty())
    to.data.reserve(ImageSize{to.size.width, (reduction.height + step - 1) / step}.pixels());
  for (int y = (step - first_row % step) % step; y < rows.size.height; y += step) {
    if (const T* row = &rows.at(0, y); step == 1)
      to.data.insert(to.data.end(), row, row + rows.size.width);
    else
      for (int x = 0; x < rows.size.width; x += step) to.data.push_back(row[x]);
    ++to.size.height;
  }
}

/// The images that the report page shows of a whole picture or of its rows from first_row on.
void append_reduced(raster::RasterFrame& to, const raster::RasterFrame& from, int first_row,
                    const Reduction& reduction);
void append_reduced(Climb& to, const Climb& from, int first_row, const Reduction& reduction);
void append_reduced(MetricMaps& to, const MetricMaps& from, int first_row, const Reduction& reduction);
void append_reduced(Comparison& to, const raytrace::RayTracedFrame& from, int first_row,
                    const Reduction& reduction);

}  // namespace gnomon::compare
