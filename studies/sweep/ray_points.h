// What the ray tracer itself costs and gets wrong, as points beside a sweep's cells: its precisions, and for
// lights with size its samples per point. Judged by the exact precision (with reference_samples).
// Kept in DIR/ray_tracer.json.
#pragma once

#include <string>
#include <vector>

#include "raytrace/frame.h"
#include "scene/base/expected.h"

namespace gnomon::studies {

struct RayPoint {
  std::string name;            ///< "robust", "robust, 16 samples"
  std::uint64_t compared = 0;  ///< pixels that show a surface which a light can reach, all lights
  /// Lit for shadowed or the reverse, another receiver, or (lights with size) visibility off by more than one
  /// half; and ambiguous.
  std::uint64_t wrong = 0, uncertain = 0;
  double mean_absolute = 0.0;  ///< of the visibilities' differences
  Times times;                 ///< camera and shadow rays, ms
  Times shadow_times;          ///< the shadow rays' part of it; sweeps made before have none
  std::uint64_t rays = 0;      ///< of both kinds
  double boxes_per_ray = 0.0, primitives_per_ray = 0.0;  ///< tested, over a sample of both kinds
  std::uint64_t bytes = 0;                               ///< of the acceleration structure
};

inline constexpr int reference_samples = 256;

/// Camera and lights are those that the world's scene has. `options`: size, runs and seed count.
std::vector<RayPoint> measure_ray_points(const World& world, raytrace::Accel accel,
                                         const std::vector<std::uint32_t>& lights,
                                         const raytrace::RaytraceOptions& options);

std::string ray_points_json(const std::vector<RayPoint>& points);
/// Reads DIR/ray_tracer.json; none where there is no such file. Errors are ErrorKind::bad_input.
Expected<std::vector<RayPoint>> read_ray_points(const std::string& folder);
inline constexpr const char* ray_points_name = "ray_tracer.json";
std::string ray_points_path(const std::string& folder);

}  // namespace gnomon::studies
