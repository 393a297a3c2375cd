#include "compare/bleeding.h"

#include <tbb/parallel_for.h>

#include "compare/filter_parameters.h"

namespace gnomon::compare {
namespace {

constexpr int probes = 5;                      // on a side
constexpr float visible_step = 0.5f / 255.0f;  // half a step of an 8-bit picture

// The tangent plane's point on the light ray through (u, v) sees the light. Where that ray does not meet the
// plane from the front there is no such point.
bool plane_is_lit(const LadderInput& in, const raytrace::SurfacePoint& receiver, int face, double u,
                  double v) {
  const LightView& view = in.record.map.view;
  const Ray ray = texel_ray(view, face, u, v);
  const double facing = glm::dot(receiver.normal, ray.direction);
  if (!(facing < 0.0)) return false;
  const double t = glm::dot(receiver.normal, receiver.position - ray.origin) / facing;
  if (view.projection == LightProjection::perspective && !(t > 0.0)) return false;
  raytrace::SurfacePoint there = receiver;
  there.position = ray.at(t);
  return in.tracer.light_verdict(there, in.light) == raytrace::Verdict::lit;
}

bool shadowed_up_to_bias(const std::array<Image<float>, rung_count>& rungs, std::size_t pixel) {
  for (std::size_t k = 0; k + 1 < rung_count; ++k)
    if (rungs[k].data[pixel] > 0.0f) return false;
  return true;
}

}  // namespace

bool lit_within_reach(const LadderInput& in, std::size_t pixel, double reach_texels) {
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const int face = in.record.face.data[pixel];
  const TexelCoordinate at = project_to_face(in.record.map.view, face, receiver.position);
  for (int j = 0; j < probes; ++j) {
    for (int i = 0; i < probes; ++i) {
      const double du = (2.0 * i / (probes - 1) - 1.0) * reach_texels;
      const double dv = (2.0 * j / (probes - 1) - 1.0) * reach_texels;
      if (plane_is_lit(in, receiver, face, at.u + du, at.v + dv)) return true;
    }
  }
  return false;
}

BleedingStats measure_bleeding(const LadderInput& in, const std::array<Image<float>, rung_count>& rungs,
                               const Image<Label>& labels) {
  BleedingStats out;
  if (!raster::uses_moments(in.drawn.options.map.technique)) return out;
  const double reach = filter_reach_texels(in.drawn.options.map);
  const auto width = static_cast<std::size_t>(labels.size.width);
  std::vector<BleedingStats> rows(static_cast<std::size_t>(labels.size.height));
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) {
    for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
      const float bled = rungs[6].data[i];
      if (!is_compared(labels.data[i]) || bled < visible_step || !shadowed_up_to_bias(rungs, i)) continue;
      if (lit_within_reach(in, i, reach)) continue;
      ++rows[y].pixels;
      rows[y].mean += bled;
      rows[y].max = std::max(rows[y].max, double{bled});
    }
  });
  std::uint64_t compared = 0;
  for (const Label label : labels.data) compared += is_compared(label) ? 1 : 0;
  for (const BleedingStats& row : rows) {
    out.pixels += row.pixels;
    out.mean += row.mean;
    out.max = std::max(out.max, row.max);
  }
  if (compared > 0) out.mean /= static_cast<double>(compared);
  return out;
}

}  // namespace gnomon::compare
