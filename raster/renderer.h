// The rasterizer: shadow-mapped pictures through offscreen OpenGL 4.5. OpenGL itself is private to this room.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "raster/frame.h"
#include "raster/gl/context.h"
#include "scene/base/expected.h"
#include "scene/effects.h"
#include "scene/world.h"

namespace gnomon::raster {

/// Holds one world's GPU resources; render() may be called again with other options, lights and cameras.
/// The picture is linear radiance: emission, and (1 - mirror - transmission) of ambient and Blinn-Phong
/// light; no reflections. Each call leaves the context with its default framebuffer, no program, and no
/// depth, cull or blend state.
class Renderer {
 public:
  /// Uploads the world and compiles the shader permutations that `plan` calls for.
  /// The world and its scene must outlive the renderer. `shader_folder`: files in it take the place of those
  /// of the same name in shaders/ ("technique/pcf_box.glsl"); empty: none. Error (bad input) with file and
  /// line when one of them does not compile; in render() when it is first asked for then.
  static Expected<std::unique_ptr<Renderer>> create(std::unique_ptr<Context> context, const World& world,
                                                    const EffectPlan& plan,
                                                    const std::string& shader_folder = {});
  virtual ~Renderer() = default;

  /// Renders all lights into the picture; `lights` (indices in Scene::lights) get a LightRecord each.
  /// Errors: usage for a choice outside its range; graphics (exit 5) for a map larger than the context
  /// allows, out of memory, a GL error; never a silent shrink; internal when the work is interrupted
  /// (scene/base/interruptible.h), after which the next frame is drawn as if this one had never been begun. The lights and camera are read from the
  /// world's scene at each call, so a viewer may change them in between.
  virtual Expected<RasterFrame> render(const RasterOptions& options,
                                       std::span<const std::uint32_t> lights) = 0;
  /// What the drawings of RasterOptions::span_drawings took in the last frame that had them, once. None: not known yet; where the
  /// device has a clock of its own, a browser's worker learns it only after the turn that drew.
  virtual std::optional<ShadowSpans> take_spans() = 0;
  /// What the technique asks, hybrid or rays; it is kept from frame to frame. Without it that technique is an error.
  virtual void use_external_visibility(Technique technique,
                                       std::shared_ptr<ExternalVisibility> visibility) = 0;
  virtual const ContextInfo& info() const = 0;
};

// Maps fitted to another camera than the one whose picture is drawn. The picture's pixels then show receivers that
// stay where they are in the world, while each drawing has the map that the moving camera would get. This is V6 at
// fixed receivers, by the very programs that draw the picture, and so without any reprojection (docs/shimmer.md).

/// The camera that maps are fitted to. `shift` and `margin` are for a map that follows the camera by translation
/// alone: the window fitted to `camera` is wider by `margin` on each side and then moved.
struct MapCamera {
  Camera camera;
  Vec3 shift{0.0};      ///< world units; orthographic maps move by what of it lies across the light
  double margin = 0.0;  ///< world units, >= 0; of orthographic maps without a warp
};

/// From the next frame on; nothing: the picture's own camera, as it is at first. The renderer is one that
/// Renderer::create made.
void set_map_camera(Renderer& renderer, const std::optional<MapCamera>& camera);

}  // namespace gnomon::raster
