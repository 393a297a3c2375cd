// What each pixel shows, as far as the report page needs it: an eighth of the size of the ray tracer's receivers.
#pragma once

#include <glm/ext/vector_int3_sized.hpp>

#include "raytrace/tracer.h"
#include "scene/image.h"

namespace gnomon::compare {

struct SeenSurface {
  static constexpr double normal_steps = 32767.0;
  std::uint32_t primitive = no_id;
  /// The geometric one, in normal_steps, on the side of the camera; 0 where there is none.
  glm::i16vec3 normal{0};

  SeenSurface() = default;
  explicit SeenSurface(const raytrace::SurfacePoint& receiver);
};

Image<SeenSurface> seen_surfaces(const Image<raytrace::SurfacePoint>& receivers);

}  // namespace gnomon::compare
