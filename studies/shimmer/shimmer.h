// A film of one scene whose receivers stay where they are while camera or light move. They are those that the first
// frame's pixels see. From it follow flips, the temporal budget and the speed of edges (docs/shimmer.md).
#pragma once

#include <functional>

#include "compare/compare.h"
#include "compare/path.h"
#include "raytrace/sheets/sheets.h"
#include "studies/shimmer/temporal.h"

namespace gnomon::studies {

struct ShimmerOptions : compare::FilmPlan {
  compare::CompareOptions compare;  ///< times are not taken
  /// Climb the ladder. Without it flips are counted and nobody is charged with them: all rungs but V0 are V6.
  bool explain = true;
};

struct ShimmerLight {
  std::uint32_t light = 0;  ///< index in Scene::lights
  TemporalBudget temporal;
  std::vector<WorstReceiver> worst{};
  double texel_world = 0.0;  ///< of the first frame's map, as a bias in texels is measured
  /// With MapOptions::snap, of a directional light: the same without it.
  std::optional<double> texel_world_unsnapped{};
  std::uint64_t receivers = 0;  ///< counted in the first frame
};

struct Shimmer {
  compare::Ladder ladder() const { return compare::ladder_of(options.compare.raster.map.technique); }
  const World* world = nullptr;
  ShimmerOptions options;
  Image<raytrace::SurfacePoint> receivers;  ///< by pixel of the first frame
  std::vector<ShimmerLight> lights;
  raster::ContextInfo context;
  Times frame_ms;  ///< by frame: maps, drawing, truth where it changes, rungs
  double accel_build_ms = 0.0;
};

/// A frame as it is made, for whoever keeps films of it; `lights` in the order asked for.
struct ShimmerFrame {
  int frame = 0;
  const Shimmer& shimmer;  ///< up to this frame
  const raster::RasterFrame& drawn;
};
using FrameSink = std::function<Expected<void>(const ShimmerFrame&)>;

inline constexpr std::size_t worst_receivers = 16;

/// `scene` is the world's own; its camera and lights are moved from frame to frame and stand as they were at the end.
/// The truth is traced again only for frames in which a light or an object moved; maps are drawn again for each. Where
/// objects move, a receiver counts in the frames in which it stands where it stood in the first, and is seen there.
/// Errors: bad input where an object has other triangles than in the first frame.
Expected<Shimmer> film_shimmer(const World& world, Scene& scene, raster::Renderer& renderer,
                               std::span<const std::uint32_t> lights, const ShimmerOptions& options,
                               const FrameSink& sink = {}, const compare::Progress& progress = {});

/// What a comparison of the same world has made already.
struct FilmTools {
  const raytrace::Tracer& tracer;
  const raytrace::Topology& topology;
  const raytrace::RayTracedFrame& truth;  ///< of the scene as it stands, by the same options
};
compare::ShimmerFigures shimmer_figures(const compare::FilmPlan& plan, const ShimmerLight& light);
/// The figures alone, of each light in turn; nothing is explained.
Expected<std::vector<compare::ShimmerFigures>> count_flips(const FilmTools& tools, const World& world,
                                                           Scene& scene, raster::Renderer& renderer,
                                                           std::span<const std::uint32_t> lights,
                                                           const ShimmerOptions& options);

/// The camera that the receivers are those of.
Camera first_camera(const compare::FilmPlan& plan, const Scene& scene);

}  // namespace gnomon::studies
