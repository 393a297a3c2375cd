#include "compare/result/shadow_cost.h"

#include <algorithm>

#include "raster/technique_traits.h"

namespace gnomon::compare {

TimeDifference shadow_lookups(const raster::LightRecord& drawn) {
  return beyond_part(drawn.shade_pass, drawn.unshadowed_pass);
}

TimeDifference map_and_lookups(const raster::LightRecord& drawn) {
  TimeDifference sum = shadow_lookups(drawn);
  if (sum.timed()) sum += drawn.map_pass.median();
  return sum;
}

Times standing_rays(const raytrace::LightTruth& truth) {
  return truth.is_soft() ? truth.soft_shadow_rays
                         : beyond_part(truth.shadow_rays, truth.light_structure).pairs;
}

bool is_software(const raster::ContextInfo& context) {
  constexpr std::array names{"llvmpipe", "softpipe", "SWR", "swrast"};
  return std::any_of(names.begin(), names.end(), [&context](const char* name) {
    return context.renderer.find(name) != std::string::npos;
  });
}

std::optional<std::uint64_t> count_lookups(const raster::RasterFrame& frame, const raster::LightRecord& drawn,
                                           const Image<Label>& labels) {
  if (!raster::compares_depths(frame.options.map.technique)) return std::nullopt;
  if (frame.custom_shader || drawn.lookups.data.size() != labels.data.size()) return std::nullopt;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < labels.data.size(); ++i)
    sum += is_compared(labels.data[i]) ? drawn.lookups.data[i] : 0u;
  return sum;
}

void add_ray_work(const raytrace::Tracer& tracer, const Light& light,
                  const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                  std::size_t first_pixel, std::size_t all_pixels, RayWork& sum) {
  constexpr std::size_t about = 1024;  // rays
  raytrace::WorkCounts work;
  const std::size_t step = std::max<std::size_t>(1, all_pixels / about);
  std::size_t next = step / 2;
  if (next < first_pixel) next += (first_pixel - next + step - 1) / step * step;
  for (std::size_t i = next - first_pixel; i < labels.data.size(); i += step) {
    if (!is_compared(labels.data[i])) continue;
    static_cast<void>(tracer.occluded(tracer.shadow_ray(receivers.data[i], light), work));
    ++sum.rays;
  }
  sum.boxes += work.boxes, sum.primitives += work.primitives;
}

}  // namespace gnomon::compare
