#include "compare/compare.h"

namespace gnomon::compare {

Expected<Comparison> compare_world(const World& world, raster::Renderer& renderer,
                                   std::span<const std::uint32_t> lights, const CompareOptions& options,
                                   const Progress& progress) {
  const raytrace::Tracer tracer(world, options.accel, options.precision);
  Comparison out;
  const auto measured =
      measure(out, plan_of(tracer, lights, options), frames_of(tracer, renderer, lights, options), progress);
  if (!measured) return fail(measured.error());
  return out;
}

}  // namespace gnomon::compare
