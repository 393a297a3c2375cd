// Pictures of hard lights alone.
#include "raytrace/shading/picture_kernels.h"

namespace gnomon::raytrace {

PictureKernel plain_kernel(const EffectPlan& plan, const RaytraceOptions& options) {
  return choose_kernel<false, false>(plan, options);
}

}  // namespace gnomon::raytrace
