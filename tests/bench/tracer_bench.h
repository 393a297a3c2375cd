// The tracer against Embree 3 on one scene. Both get the same rays; hits and occlusions are counted and compared.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "bench_scenes.h"
#include "benchmark/row.h"
#include "raytrace/frame.h"

namespace gnomon::bench {

struct Settings {
  ImageSize size{1920, 1080};
  std::vector<ImageSize> whole_sizes{{1280, 720}, {1920, 1080}};  ///< of whole commands
  int runs = 5;
  std::string json;
  std::vector<std::string> scenes;
  std::string target;  ///< of instruction_sets(); empty: the best that the machine has
  /// stdout is the rows' where they go there.
  std::FILE* table() const { return json == "-" ? stderr : stdout; }
};

/// Prints each row as it is measured.
std::vector<BenchRow> bench_tracer(const BenchScene& scene, const Settings& settings);

// The share that points see of a light with size, with the shaft (raytrace/shading/light_shaft.h) and by every ray.

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
