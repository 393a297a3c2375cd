// SSIM: structural similarity of two grey images, in [-1, 1], 1 for equal images.
// Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment: From Error Visibility to Structural
// Similarity", IEEE Trans. Image Processing 13(4), section III: Gaussian window of 11x11 pixels with
// sigma 1.5, K1 = 0.01, K2 = 0.03, dynamic range 1, no downsampling.
#pragma once

#include "scene/image.h"

namespace gnomon::compare {

inline constexpr int ssim_window = 11;  ///< pixels

/// The index at every window that lies wholly in the picture: 10 pixels fewer each way than the images, or an
/// empty image when they are smaller than a window. Both images of one size, finite.
Image<float> ssim_map(const Image<float>& reference, const Image<float>& test);

/// A map's values at the middle pixels of their windows in a picture of `size`; NaN elsewhere.
Image<float> ssim_by_pixel(const Image<float>& map, ImageSize size);

/// Mean of a map; NaN of none.
double mean_ssim(const Image<float>& map);
/// Mean of ssim_map (the paper's MSSIM); NaN when no window fits.
double mean_ssim(const Image<float>& reference, const Image<float>& test);

}  // namespace gnomon::compare
