// The ray-traced picture of a frame whose receivers and shadows are known. Every kind of path has its own
// loop (raytrace/shading/picture_kernels.h); the plan chooses it.
#pragma once

#include "raytrace/frame.h"
#include "raytrace/shading/interior.h"
#include "raytrace/shading/sampling.h"

namespace gnomon::raytrace {

struct UnstoredReceivers;

/// The key of one pixel's samples of one light.
constexpr std::uint64_t pixel_key(std::uint64_t seed, std::size_t pixel, std::uint32_t light) {
  return sample_key(sample_key(seed, pixel), light);
}

/// The closed bodies of glass that hold a place. rays: adds those that it took to find them.
Interior interior_at(const Tracer& tracer, const Vec3& place, std::uint64_t& rays);

/// Fills frame.color and adds the rays that it casts. options.size is the frame's, which holds the rows of the
/// view's picture from first_row on. `unstored`: the receivers, where the frame has none.
void shade_picture(const Tracer& tracer, const EffectPlan& plan, const View& view, int first_row,
                   const RaytraceOptions& options, const UnstoredReceivers* unstored, RayTracedFrame& frame);

}  // namespace gnomon::raytrace
