// The soft-shadow pass: where the light's visibility is the same for all of its points, one answer of the
// hard-shadow pass for the light's centre is the whole truth; samples are spent in penumbrae alone, and there
// they are the ray tracer's own (same seed, same rays). So the result is full sampling's at every pixel.
//
// Proof. Let x be a receiver with the whole light above its horizon, and let the light's points be joined by
// a path inside the light's convex hull. While l moves along it, the number of surfaces that the segment xl
// meets changes only in these places:
// - where the segment passes over the end of a surface
// - where it passes over an edge at which a surface folds away (as seen along xl both triangles lie on one
//   side)
// - where l crosses a surface
// - on a sphere, where the segment touches its outline
// None of them lies in the hull of x and the light under three conditions. No edge of hybrid/soft_edges.h
// meets the hull. No plane separates the light's corners. Every sphere is missed by all segments or met by
// those to all corners (what a ball hides from x is convex). Then all points of the light are seen, or none.
// Whatever is only nearly so counts as penumbra.
#pragma once

#include "hybrid/hard_shadows.h"
#include "hybrid/soft_edges.h"

namespace gnomon::hybrid {

struct SoftCounts {
  std::uint64_t penumbra = 0;  ///< receivers that were sampled
  std::uint64_t rays = 0;      ///< to samples
};

struct SoftSamples {
  int count = 0;  ///< of each receiver
  std::uint64_t seed = 0;
  std::size_t first_pixel = 0;  ///< the first receiver's number in the camera's picture
};

class SoftLight {
 public:
  /// The light has a size; all must outlive it.
  SoftLight(const raytrace::Tracer& tracer, const raytrace::Topology& topology, std::uint32_t light);

  /// `centre` and `decisions` of the light's centre, from trace_hard_shadows; decisions become `traced`
  /// where samples were. `visibility`: the share of the light that each receiver sees, as in
  /// raytrace::LightTruth.
  SoftCounts find(const Image<raytrace::SurfacePoint>& receivers,
                  const Image<raytrace::PointVisibility>& centre, const SoftSamples& samples,
                  Image<Decision>& decisions, Image<float>& visibility) const;

  std::uint64_t bytes() const { return edges_.bytes(); }

 private:
  class Block;
  bool in_penumbra(const raytrace::SurfacePoint& point, std::span<const std::uint32_t> edges) const;
  bool horizon_cuts(const raytrace::SurfacePoint& point) const;
  bool plane_cuts(const Plane& plane, const raytrace::SurfacePoint& point) const;
  bool sphere_cuts(const Sphere& sphere, bool own, bool masked, const raytrace::SurfacePoint& point,
                   const LightCone& cone) const;
  bool shapes_cut(const raytrace::SurfacePoint& point, const LightCone& cone) const;

  const raytrace::Tracer& tracer_;
  std::uint32_t index_;
  const Light& light_;
  double reach_;  // no coordinate of a receiver is larger, else it is sampled
  double position_error_;
  LightHull hull_;
  SoftEdges edges_;
};

}  // namespace gnomon::hybrid
