// The comparison of a picture that is too large for memory: drawn, traced and climbed band by band. Every number, every
// picture and every channel is that of the whole, to the last bit (tests/compare_bands_gl_test.cpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compare/bands/picture_store.h"
#include "compare/compare.h"
#include "compare/outputs.h"
#include "scene/files/exr_file.h"

namespace gnomon::compare {

struct BandedInput {
  const raytrace::Tracer& tracer;  ///< of `options`
  raster::Renderer& renderer;
  std::span<const std::uint32_t> lights;
  const CompareOptions& options;
  std::vector<PictureRows> bands;
  std::string folder;            ///< for what waits on the disk; "": the present one
  bool page = true;              ///< whether the images that the report page shows are wanted
  std::string command{}, aov{};  ///< as Comparison::command; a path as write_aov() has it, "": not wanted
};

/// What a banded comparison has beside its numbers.
struct BandedParts {
  PictureStore pictures;
  CascadeTables cascades;
  std::vector<ExrFile> channels;  ///< --aov, by light; appear when they are closed
};

struct BandedComparison {
  /// Its images hold each image_step()-th pixel of each such row.
  Comparison comparison;
  std::unique_ptr<BandedParts> parts;
};

/// As compare_world(), of the tracer's world.
Expected<BandedComparison> compare_in_bands(const BandedInput& input, const Progress& progress = {});

}  // namespace gnomon::compare
