// Visibility that is worked out outside OpenGL, from what the camera sees, and shaded like any other
// (Technique::hybrid and rays). The rasterizer hands over its visibility buffer and gets back an image.
#pragma once

#include <cstdint>
#include <optional>

#include "raster/options.h"
#include "scene/base/expected.h"
#include "scene/base/timing.h"
#include "scene/camera.h"
#include "scene/image.h"
#include "scene/light_map/light_view.h"

namespace gnomon::raster {

/// One light of one frame. All must outlive the call only.
struct VisibilityRequest {
  std::uint32_t light = 0;  ///< index in Scene::lights
  const LightView& map;     ///< fitted for the light at the map size asked for
  const View& camera;
  const MapOptions& options;
  int shadow_samples = 0;         ///< to a light with size; 0: as the light says
  std::uint64_t seed = 0;         ///< of the samples
  std::optional<int> film_frame;  ///< RasterOptions::film_frame
  bool analysis = false;          ///< of one picture; else it may be one of many in a row, made for speed
};

/// Says who decided one pixel; the first two were sure without a ray.
enum class Decision : std::uint8_t { shadowed = 0, lit = 1, traced = 2, not_asked = 3 };

/// What a light's visibility took. Shares are of `receivers`, the pixels that the light can reach.
struct ExternalCosts {
  std::uint64_t receivers = 0;
  std::uint64_t surely_lit = 0, surely_shadowed = 0;
  std::uint64_t penumbra = 0;    ///< receivers that were sampled, of a light with size
  std::uint64_t rays = 0;        ///< cast
  std::uint64_t all_rays = 0;    ///< that pure ray tracing asks for: every sample of every receiver
  std::uint64_t silhouette = 0;  ///< pixels whose ray misses the primitive that the rasterizer shows there
  std::uint64_t bytes = 0;       ///< held for the light
  /// ms, of what is kept while light and world stand still, with what the first frames that ask for it add; and that part.
  Times build;
  double build_later_ms = 0.0;
  Times receivers_ms,
      shadow;     ///< ms, of each frame: the receivers; their visibility, of Technique::rays its rays
  Times denoise;  ///< Technique::rays: ms, of each frame
  std::uint64_t taps =
      0;  ///< Technique::rays: values of neighbours and of the history that the denoiser reads in a frame
  double boxes_per_ray = 0.0, primitives_per_ray = 0.0;  ///< Technique::rays: tested; 0: not counted
  Image<std::uint8_t> decision;  ///< the Decision of each pixel; of Technique::rays empty
  /// Triangles tested for the rays cast, and for all rays, by a walk that counts; 0: not counted.
  std::uint64_t triangle_tests = 0, all_triangle_tests = 0;
};

class ExternalVisibility {
 public:
  virtual ~ExternalVisibility() = default;
  /// Makes what is kept for the light, again or (when nothing changed) not at all.
  virtual Expected<void> prepare(const VisibilityRequest& request, bool changed) = 0;
  /// `primitive`: what each pixel shows, or no_id. `visibility` (of the same size): 1 lit, 0 shadowed; 1
  /// where there is nothing to see.
  virtual Expected<void> find(const VisibilityRequest& request, const Image<std::uint32_t>& primitive,
                              Image<float>& visibility) = 0;
  /// Returns the costs of the last light asked for. `counted`: triangle tests too, which takes as long as tracing it all.
  virtual ExternalCosts costs(const VisibilityRequest& request, bool counted) = 0;
};

}  // namespace gnomon::raster
