#include "raytrace/band.h"

namespace gnomon::raytrace {
namespace {

/// Run by run; a pass that some band ran less often counts as often as there.
void add_times(const Times& band, Times& sum) {
  if (sum.runs.empty()) {
    sum = band;
    return;
  }
  sum.runs.resize(std::min(sum.runs.size(), band.runs.size()));
  for (std::size_t i = 0; i < sum.runs.size(); ++i) sum.runs[i] += band.runs[i];
}

}  // namespace

void add_costs(const RayTracedFrame& band, RayTracedFrame& sum) {
  const std::uint64_t interior = std::max(sum.rays.interior, band.rays.interior);
  sum.rays += band.rays;
  sum.rays.interior = interior;
  add_times(band.primary_rays, sum.primary_rays);
  sum.picture_ms += band.picture_ms;
  sum.non_finite += band.non_finite;
  if (sum.lights.empty()) sum.lights.resize(band.lights.size());
  for (std::size_t i = 0; i < sum.lights.size(); ++i) {
    const LightTruth& part = band.lights[i];
    LightTruth& truth = sum.lights[i];
    truth.light = part.light, truth.samples = part.samples;
    truth.rays += part.rays, truth.soft_rays += part.soft_rays;
    truth.soft_rays_asked += part.soft_rays_asked;
    add_times(part.shadow_rays, truth.shadow_rays);
    add_times(part.light_structure, truth.light_structure);
    add_times(part.soft_shadow_rays, truth.soft_shadow_rays);
  }
}

}  // namespace gnomon::raytrace
