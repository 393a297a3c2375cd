// What a denoiser knows of each pixel beside its rays: where the surface is, how it is turned, and how large a pixel is on it.
#pragma once

#include "raytrace/tracer.h"
#include "scene/camera.h"
#include "scene/image.h"
#include "scene/light.h"

namespace gnomon::rays {

struct Guide {
  Vec3f place{0.0f};        ///< world units from the eye
  float footprint = 0.0f;   ///< a pixel's side there, world units; 0: no ray is cast to the light
  Vec3f normal{0.0f};       ///< geometric, unit, on the camera's side
  float depth = 0.0f;       ///< along the camera's forward axis, world units
  Vec2f depth_slope{0.0f};  ///< of the surface's tangent plane, world units for a pixel to the right and down
  bool asked() const { return footprint > 0.0f; }
};

using Guides = Image<Guide>;

/// Of the receivers of rows of the view's picture, from first_row on, under one light. A pixel is asked where it shows a surface
/// that receives shadows and that the light can reach.
Guides make_guides(const raytrace::Tracer& tracer, const View& view, int first_row, const Light& light,
                   const Image<raytrace::SurfacePoint>& receivers);

/// The distance of q's place from p's tangent plane, world units.
inline float off_plane(const Guide& p, const Guide& q) {
  return std::abs(glm::dot(p.normal, q.place - p.place));
}

}  // namespace gnomon::rays
