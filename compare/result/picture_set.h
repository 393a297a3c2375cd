// Every picture of a comparison, drawn and encoded once, for the folder and for the report page alike.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "scene/base/expected.h"

namespace gnomon::compare {

struct EncodedPicture {
  std::string file_name;  ///< in the output folder
  ImageSize size;
  std::string png;
};

struct LightPictures {
  EncodedPicture difference, labels;
  EncodedPicture error, flip, ssim;  ///< maps of the metrics; FLIP and SSIM only where computed
  EncodedPicture decisions;          ///< of the hybrid alone
  EncodedPicture edges, detachment;  ///< maps of displacement, where made
  EncodedPicture depth_map;          ///< as many pixels as texels, up to 4096 wide
  EncodedPicture depth_map_small;    ///< for the page: up to 1024 wide
  /// One pixel of the picture per step x step texels, which shows the nearest depth of them.
  int depth_map_step = 1, depth_map_small_step = 1;
};

struct PictureSet {
  EncodedPicture raster, raytraced;
  std::vector<LightPictures> lights;  ///< as Comparison::lights
};

class PictureStore;  // measure/pictures.h

/// Draws and encodes all pictures in parallel. `store`: of a comparison in bands what they are drawn from, as many at a
/// time as memory has room for; null: the comparison has all images.
Expected<PictureSet> encode_pictures(const Comparison& comparison, const PictureStore* store = nullptr);

/// What a light's file names end in: nothing for the only one.
std::string light_suffix(const Comparison& comparison, const LightComparison& light);

/// A map with one texel for every step x step block, which keeps the block's nearest depth, so that thin
/// casters stay visible. Only `view.size` and `depth` are meaningful in it.
raster::ShadowMap reduced_map(const raster::ShadowMap& map, int step);

}  // namespace gnomon::compare
