// How techniques without a pass of their own draw.
#include <fmt/core.h>

#include <cmath>

#include "raster/passes/technique_pass.h"
#include "raster/programs/programs.h"
#include "raster/technique_traits.h"
#include "scene/light.h"
#include "scene/light_map/cascade_fit.h"

namespace gnomon::raster {
namespace {

TechniqueShader pcf_shader(const MapOptions& options, const Light& /*light*/) {
  const FilterOptions& filter = options.filter;
  switch (filter.kernel) {
    case FilterKernel::box:
      return {"pcf_box", {define("BOX_SIZE", 2 * static_cast<int>(filter.radius_texels) + 1)}};
    case FilterKernel::hardware:
      return {"pcf_hardware", {}};
    case FilterKernel::vogel:
      return {"pcf_vogel", {define("FILTER_SAMPLES", filter.samples)}};
    case FilterKernel::optimised:
      break;
  }
  // The square overlaps at most ceil(2 radius) + 1 texels of a row.
  const int texels = static_cast<int>(std::ceil(2.0 * filter.radius_texels)) + 1;
  return {"pcf_optimised", {define("PAIRS", (texels + 1) / 2)}};
}

TechniqueShader pcss_shader(const MapOptions& options, const Light& light) {
  if (!has_size(light)) return {};  // no penumbra: the hard test
  const FilterOptions& filter = options.filter;
  return {"pcss",
          {std::string(shape_define(light.extent)), define("FILTER_SAMPLES", filter.samples),
           define("BLOCKER_SAMPLES", filter.blocker_samples)}};
}

TechniqueShader cascade_shader(const MapOptions& options, const Light& /*light*/) {
  return mixes_cascades(options) ? TechniqueShader{"cascade_blend", {}} : TechniqueShader{};
}

TechniqueShader external_shader(const MapOptions& /*options*/, const Light& /*light*/) {
  return {"external", {"EXTERNAL"}};
}

Expected<LightView> fit_to_cascades(const World& world, const Light& light, const Camera& camera,
                                    double aspect, const MapOptions& options, std::span<const Vec3> visible) {
  return fit_cascades(world, light, camera, aspect, options.size, options.cascades, visible);
}

Expected<LightView> fit_to_warp(const World& world, const Light& light, const Camera& camera, double aspect,
                                const MapOptions& options, std::span<const Vec3> /*visible*/) {
  return fit_warped(world, light, camera, aspect, options.size, options.snap);
}

}  // namespace

extern const TechniqueDrawing hard_drawing{};
extern const TechniqueDrawing pcf_drawing{.shader = pcf_shader};
extern const TechniqueDrawing pcss_drawing{.shader = pcss_shader};
extern const TechniqueDrawing csm_drawing{
    .shader = cascade_shader, .fit = fit_to_cascades, .map_define = "CASCADES"};
extern const TechniqueDrawing lispsm_drawing{.fit = fit_to_warp, .map_define = "WARP"};
extern const TechniqueDrawing hybrid_drawing{.shader = external_shader, .reads_gap = false};
extern const TechniqueDrawing rays_drawing{.shader = external_shader, .reads_gap = false};

TechniqueShader technique_shader(const MapOptions& options, const Light& light) {
  const auto shader = traits_of(options.technique).drawing->shader;
  return shader != nullptr ? shader(options, light) : TechniqueShader{};
}

}  // namespace gnomon::raster
