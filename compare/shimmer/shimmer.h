// A film of one scene whose receivers, those that the first frame's pixels see, stay where they are while camera or
// light move, and all that follows from it: flips, the temporal budget, the speed of edges (docs/shimmer.md).
#pragma once

#include <functional>

#include "compare/compare.h"
#include "compare/shimmer/path.h"
#include "compare/shimmer/temporal.h"

namespace gnomon::compare {

struct ShimmerOptions {
  CompareOptions compare;  ///< times are not taken
  ShimmerPath path;
  FilmTime time;
  int anchors = 1;  ///< receivers at every so many pixels along both axes, in [1, 64]
};

struct ShimmerLight {
  std::uint32_t light = 0;  ///< index in Scene::lights
  TemporalBudget temporal;
  std::vector<WorstReceiver> worst{};
  double texel_world = 0.0;     ///< of the first frame's map, as a bias in texels is measured
  std::uint64_t receivers = 0;  ///< counted in the first frame
};

struct Shimmer {
  const World* world = nullptr;
  ShimmerOptions options;
  Image<raytrace::SurfacePoint> receivers;  ///< by pixel of the first frame
  ColorImage first_picture;                 ///< as the rasterizer drew it, linear
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

/// `scene` is the world's own; its lights are moved from frame to frame and stand as they were at the end. The
/// truth is traced again only for frames in which a light moved; maps are drawn anew for each.
Expected<Shimmer> film_shimmer(const World& world, Scene& scene, raster::Renderer& renderer,
                               std::span<const std::uint32_t> lights, const ShimmerOptions& options,
                               const FrameSink& sink = {}, const Progress& progress = {});

}  // namespace gnomon::compare
