// The share that points see of a light with size, with the shaft (raytrace/shading/light_shaft.h) and by
// every ray.
#pragma once

#include <vector>

#include "raytrace/frame.h"

namespace gnomon::bench {

class BallLight {
 public:
  static constexpr int samples = 64;
  /// The point light grown to a ball, seen from every 16th pixel; the tracer must outlive this.
  BallLight(const raytrace::Tracer& tracer, const raytrace::RayTracedFrame& frame, const Light& point);

  double rays() const { return static_cast<double>(samples * points_.size()); }
  /// Means over the points.
  double share_by_shaft() const;
  double share_by_every_ray() const;

 private:
  const raytrace::Tracer& tracer_;
  Light light_;
  std::vector<raytrace::SurfacePoint> points_;
};

}  // namespace gnomon::bench
