// The one path from two renderers' frames to a comparison. A picture is measured band by band, and a picture in one piece
// is one band. Every number, every picture and every channel is the same to the last bit, however it is cut
// (tests/compare/compare_bands_gl_test.cpp).
#pragma once

#include <initializer_list>
#include <memory>

#include "compare/ladder/ladder.h"
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

/// Whether the times of a drawing can be taken after all else is known of it (time_drawing): where nothing of the drawing
/// itself is timed.
bool is_timed_later(const raster::RasterOptions& options);
/// Those options for the drawing itself, which is then not timed.
raster::RasterOptions untimed(raster::RasterOptions options);
/// Draws once more what the options time, and adds the times to the frame, which was drawn with untimed() of these options by
/// the same renderer for the same lights. Errors: as of Renderer::render().
Expected<void> time_drawing(raster::Renderer& renderer, std::span<const std::uint32_t> lights,
                            const raster::RasterOptions& options, raster::RasterFrame& frame);

// The figures of a drawing that is not climbed.

/// What `measures` need of one light of a whole picture; figures that cost more are left NaN.
LightFigures measure_ends(const LadderInput& input, std::initializer_list<const Figure*> measures);

// Where the images of a picture go while it is measured: into the comparison, or of a picture in bands to the disk.

class ImageSink {
 public:
  virtual ~ImageSink() = default;
  /// Maps of the rows that follow those of the last call; rows.count may be 0.
  virtual Expected<void> keep_maps(std::size_t light, MetricMaps&& maps, const PictureRows& rows) = 0;
  /// One light's rows of a band, as `in` has them.
  virtual Expected<void> keep_light(const LadderInput& in, Climb&& climb, Image<float>&& detached,
                                    const PictureRows& rows) = 0;
  /// The band itself, after its lights.
  virtual Expected<void> keep_frames(Frames&& band, const PictureRows& rows) = 0;
  /// What both pictures are shown with; after the last band.
  virtual Expected<double> exposure() = 0;
};

/// `parts`: of a picture in bands; null: the images stay in `out`.
std::unique_ptr<ImageSink> make_sink(Comparison& out, const Plan& plan, BandedParts* parts);

}  // namespace gnomon::compare
