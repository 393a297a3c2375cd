#include "compare/compare.h"

#include <cmath>

#include "scene/base/parallel.h"

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

SeenSurface::SeenSurface(const raytrace::SurfacePoint& receiver) : primitive(receiver.primitive) {
  if (primitive == no_id) return;
  for (int k = 0; k < 3; ++k)
    if (const double steps = normal_steps * receiver.normal[k]; !std::isnan(steps))
      normal[k] = static_cast<std::int16_t>(std::round(steps));
}

Image<SeenSurface> seen_surfaces(const Image<raytrace::SurfacePoint>& receivers) {
  Image<SeenSurface> out(receivers.size);
  parallel_for(out.data.size(), [&](std::size_t i) { out.data[i] = SeenSurface(receivers.data[i]); });
  return out;
}

}  // namespace gnomon::compare
