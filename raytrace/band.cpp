#include "raytrace/band.h"

namespace gnomon::raytrace {

void add_costs(const RayTracedFrame& band, RayTracedFrame& sum) {
  const std::uint64_t interior = std::max(sum.rays.interior, band.rays.interior);
  sum.rays += band.rays;
  sum.rays.interior = interior;
  sum.primary_rays.add_part(band.primary_rays);
  sum.picture_ms += band.picture_ms;
  sum.non_finite += band.non_finite;
  if (sum.lights.empty()) sum.lights.resize(band.lights.size());
  for (std::size_t i = 0; i < sum.lights.size(); ++i) {
    const LightTruth& part = band.lights[i];
    LightTruth& truth = sum.lights[i];
    truth.light = part.light, truth.samples = part.samples;
    truth.rays += part.rays, truth.single_rays += part.single_rays, truth.soft_rays += part.soft_rays;
    truth.soft_rays_asked += part.soft_rays_asked;
    truth.shadow_rays.add_part(part.shadow_rays);
    truth.light_structure.add_part(part.light_structure);
    truth.soft_shadow_rays.add_part(part.soft_shadow_rays);
  }
}

}  // namespace gnomon::raytrace
