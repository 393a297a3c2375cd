// Pictures with indirect light of hard lights.
#include "raytrace/shading/picture_kernels.h"

namespace gnomon::raytrace {

PictureKernel indirect_kernel(const EffectPlan& plan, const RaytraceOptions& options) {
  return choose_kernel<false, true>(plan, options);
}

}  // namespace gnomon::raytrace
