// The one path from two renderers' frames to a comparison. A picture is measured band by band, and a picture in one piece
// is one band: every number, every picture and every channel is the same to the last bit, however it is cut
// (tests/compare_bands_gl_test.cpp).
#pragma once

#include <memory>

#include "compare/measure/pictures.h"
#include "compare/measure/plan.h"
#include "scene/files/pictures/exr_file.h"

namespace gnomon::compare {

/// What a comparison in bands has beside its numbers.
struct BandedParts {
  PictureStore pictures;
  std::vector<ExrFile> channels;  ///< --aov, by light; appear when they are closed
};

/// Fills in all but what only the caller knows (command, seed, machine, judged, and times beyond these). Of a picture in
/// one piece gives null; else what its pictures are drawn from, and the comparison's images hold each image_step()-th
/// pixel of each such row. Errors: those of `source`, and of the disk (cannot_write) for bands.
Expected<std::unique_ptr<BandedParts>> measure(Comparison& out, const Plan& plan, const FrameSource& source,
                                               const Progress& progress = {});

/// Measures the frames that `comparison` holds already, which show the whole picture.
Expected<void> measure_frames(Comparison& comparison, const Plan& plan,
                              const std::function<Climb(const LadderInput&)>& climb = {});

/// Both renderers at work on the scene as it is now. The renderer was made for the tracer's world; all that is given must
/// outlive the source.
FrameSource frames_of(const raytrace::Tracer& tracer, raster::Renderer& renderer,
                      std::span<const std::uint32_t> lights, const CompareOptions& options);

}  // namespace gnomon::compare
