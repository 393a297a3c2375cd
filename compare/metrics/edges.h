// How far the drawn shadow's edges lie from the true ones.
#pragma once

#include <optional>

#include "compare/comparison.h"
#include "scene/image.h"

namespace gnomon::compare {

/// Starts at every true shadow edge between two neighbouring pixels of one object that are climbed (labels_climbed). Walks along
/// the edge's normal (the gradient of the truth over a 7x7 window) in half-pixel steps until the drawn shadow has its edge there.
/// Edges that are not found within 64 pixels are missing features, not displaced edges, and are left out. Offsets are > 0 where
/// the drawn shadow is larger. Texel figures are distances between looked-up map positions, world figures between receivers.
inline constexpr int edge_margin = 136;  ///< rows above and below a row on which its edges and offsets hang

struct EdgeInput {
  const raster::RasterFrame& drawn;
  const raster::LightRecord& record;
  const Image<raytrace::SurfacePoint>& receivers;
  const Image<float>& truth;
  const Image<Label>& labels;
  const World& world;
  int first_row = 0;  ///< of the picture: row 0 of these images, of a picture in bands
};

/// Sums over edges, in their order.
struct EdgeSums {
  std::uint64_t edges = 0;
  double texels = 0.0, texels_absolute = 0.0, texels_squared = 0.0, pixels_squared = 0.0;
  double world = 0.0, world_absolute = 0.0, world_squared = 0.0;

  void add(double moved_texels, double offset_pixels, double moved_world);
  void add(const EdgeSums& other);
  EdgeStats stats() const;
};
/// Adds the edges that begin in those rows of the images; all within edge_margin of them must be there.
void add_edges(const EdgeInput& input, const PictureRows& rows, EdgeSums& sums);

/// Returns for those rows of the images the offsets in texels on the pixels that were walked over, the larger one where
/// several walks meet; NaN elsewhere.
Image<float> edge_displacement_rows(const EdgeInput& input, const PictureRows& rows);

/// Finds displacements for every constant bias of a hard test, where a pixel is drawn lit iff its gap does not exceed the
/// bias. Each walk is made once and keeps the pixels that can end it.
class EdgePaths {
 public:
  /// `labels`: which pixels are compared, and no more.
  explicit EdgePaths(const EdgeInput& input);
  EdgeStats at(float bias) const;

 private:
  struct Stop {
    float gap;
    double offset_pixels, moved_texels, moved_world;
  };
  /// Stops [first, turn) on the lit side, gaps falling; [turn, end) on the shadowed side, gaps rising.
  struct Edge {
    std::uint32_t first, turn, end;
  };
  std::vector<Stop> stops_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> row_ends_;  ///< into edges_
};

/// Whether a bias, the receiver's or the casters', lights a pixel next to its caster that should be shadowed.
inline bool is_detached(Label label, bool false_shadow) {
  return label == Label::peter_panning || (label == Label::caster_bias && !false_shadow);
}
/// Distance along the receiver between each such pixel (is_detached) and the occluder that should shadow it: t sin(angle between light and normal) for the
/// nearest occluder at t.
Detachment measure_detachment(const Image<float>& map);
/// The distances by pixel, world units; NaN where there is none. Of wrong pixels alone.
Image<float> detachment_map(const raytrace::Tracer& tracer, const Light& light,
                            const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                            const std::array<Image<float>, rung_count>& rungs);
/// Adds distances up one by one, in the order of the pixels.
class DetachmentSum {
 public:
  void add(double distance);
  Detachment stats() const;

 private:
  Detachment sums_;
};
/// Returns the distance at one pixel; none where nothing occludes it.
std::optional<double> detachment_distance(const raytrace::Tracer& tracer, const Light& light,
                                          const raytrace::SurfacePoint& receiver);

}  // namespace gnomon::compare
