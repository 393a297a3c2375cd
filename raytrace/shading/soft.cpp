// Pictures with soft shadows.
#include "raytrace/shading/picture_kernels.h"

namespace gnomon::raytrace {

PictureKernel soft_kernel(const EffectPlan& plan, const RaytraceOptions& options) {
  return choose_kernel<true, false>(plan, options);
}

}  // namespace gnomon::raytrace
