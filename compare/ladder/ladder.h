// The visibility ladder: every compared pixel climbed from the truth to what was drawn, one change at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "compare/comparison.h"
#include "compare/truth/surfaces.h"
#include "compare/truth/texel_groups.h"
#include "rays/frames.h"
#include "raytrace/sheets/sheets.h"

namespace gnomon::compare {

/// Where images lie in a picture that comes in bands.
struct ImagePlace {
  int first_row = 0;       ///< of the picture: row 0 of the images
  int picture_height = 0;  ///< 0: the images hold the whole picture
};

/// What one light's pixels are climbed with. All parts must outlive the ladder.
struct LadderInput {
  const raytrace::Tracer& tracer;
  const raytrace::Topology& topology;
  const raster::RasterFrame& drawn;
  const raytrace::RayTracedFrame& traced;
  std::size_t index = 0;  ///< of the light in both frames' lists
  ImagePlace place{};
  /// Of a film drawn by few rays: its history up to the frame before. Null: a picture by itself.
  rays::FilmPassengers* passengers = nullptr;

  const World& world() const { return tracer.world(); }
  const raster::LightRecord& record() const { return drawn.lights[index]; }
  const raytrace::LightTruth& truth() const { return traced.lights[index]; }
  const Light& light() const { return world().scene->lights[record().light]; }
};

/// Marks each pixel background, silhouette, facing_away, uncertain, or right (= to be compared). Uncertain: a
/// ray that cannot be decided, or a share of a light with size that lies within its standard error of one
/// half.
Image<Label> sort_pixels(const LadderInput& input);

/// The labels with `right` where only the samples of a light with size leave the truth open. These pixels are
/// not compared, but climbed, so that pictures and widths have no holes there.
Image<Label> labels_climbed(const LadderInput& input, const Image<Label>& labels);

/// V0: the share of the light that the pixel's receiver sees; of a light without size, all or nothing.
float true_visibility(const LadderInput& input, std::size_t pixel);

/// What the map as stored makes of the compared pixels, before the technique's bias and filter: V0 … V4. Frames of one light that were drawn with the same map share it.
struct LowerClimb {
  /// `sorted`: label `right` on what is to be compared. World and topology must outlive this.
  LowerClimb(const LadderInput& input, Image<Label> sorted);
  LowerClimb(const LowerClimb&) = delete;
  LowerClimb& operator=(const LowerClimb&) = delete;

  Image<Label> sorted;
  std::array<Image<float>, rung_count> rungs;  ///< V5 and V6 are 1, and V2 … V4 of pixels outside the map
  std::vector<std::uint32_t> outside;          ///< compared pixels whose own texel lies outside the map
  TexelGroups groups;                          ///< the other compared pixels
  /// By group, the depth along the map's forward axis of the first thing that the exact light ray through the texel's
  /// centre meets.
  std::vector<double> centres;
  Surfaces surfaces;
};

/// Whether two drawings stored the same map of a light and show the same primitives at the same places: their lower climbs
/// are the same, where the truth is.
bool have_same_lower_climb(const raster::RasterFrame& a, const raster::RasterFrame& b, std::size_t light);

/// V5 and V6 of `input`, and the labels of its wrong pixels. `input` may hold another frame than `lower` was
/// made from, as long as light, truth and map are the same.
Climb climb_up(const LowerClimb& lower, const LadderInput& input);

/// Climbs the compared pixels (label `right` on entry) and labels the wrong ones.
Climb climb(const LadderInput& input, Image<Label> sorted);

/// Whether a pixel with an error is off at rung k, too. That is so on the side of its error: by more than one half where
/// it is wrong, else by more than half of its error.
bool is_off_at(const std::array<float, rung_count>& rungs, std::size_t k);

/// The step that put a pixel off. Of one too dark it is the step at which it last came to be off (is_off_at). Of one too
/// light it is the filter where V5 is right, else the step at which it first came to be off. What darkens it in between
/// by accident, and is taken away again, is not what it lacks.
Cause deciding_step(const std::array<float, rung_count>& rungs);

// The shadow terminator: where a mesh's triangle and the smooth normal that shades it do not agree on whether they face the
// light. Both renderers let the triangle decide, so that none of it is an error of the map.
/// Counts under the light's centre; docs/labels.md has the definition. Nothing where no mesh has normals of its own.
TerminatorCount count_terminator(const LadderInput& in, const Image<Label>& labels);

}  // namespace gnomon::compare
