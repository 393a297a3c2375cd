// Pictures with soft shadows and indirect light.
#include "raytrace/shading/picture_kernels.h"

namespace gnomon::raytrace {

PictureKernel soft_indirect_kernel(const EffectPlan& plan, const RaytraceOptions& options) {
  return choose_kernel<true, true>(plan, options);
}

}  // namespace gnomon::raytrace
