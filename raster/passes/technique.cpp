// Which shader each technique is drawn by, and which pass of its own it has.
#include <fmt/core.h>

#include <cmath>

#include "raster/passes/izb_pass.h"
#include "raster/passes/midpoint_pass.h"
#include "raster/passes/moment_pass.h"
#include "raster/passes/technique_pass.h"
#include "raster/programs/programs.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::raster {
namespace {

std::string define(const char* name, int value) {
  return fmt::format("{} {}", name, value);
}

TechniqueShader pcf_shader(const FilterOptions& filter) {
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

TechniqueShader pcss_shader(const FilterOptions& filter, const Light& light) {
  if (!has_size(light)) return {};  // no penumbra: the hard test
  return {"pcss",
          {std::string(shape_define(light.extent)), define("FILTER_SAMPLES", filter.samples),
           define("BLOCKER_SAMPLES", filter.blocker_samples)}};
}

std::vector<std::string> moment_defines(const MapOptions& options, const Light& light) {
  const FilterOptions& filter = options.filter;
  const char* kind = options.technique == Technique::vsm    ? "MOMENTS_VSM"
                     : options.technique == Technique::esm  ? "MOMENTS_ESM"
                     : options.technique == Technique::evsm ? "MOMENTS_EVSM"
                                                            : "MOMENTS_MSM";
  return {kind, define("MOMENT_BORDER", moment_border(filter, light.type))};
}

TechniqueShader moment_technique(const MapOptions& options, const Light& light) {
  TechniqueShader shader{std::string(technique_name(options.technique)), moment_defines(options, light)};
  if (!options.filter.mipmaps) return shader;
  shader.defines.emplace_back("MIPMAPS");
  shader.defines.push_back(define("MAX_LEVEL", moment_max_level(options.filter, light.type, options.size)));
  return shader;
}

}  // namespace

std::vector<std::string> moment_shader(const MapOptions& options, const Light& light, const LightView& view) {
  std::vector<std::string> defines = moment_defines(options, light);
  if (light.type != LightType::directional) defines.emplace_back("PERSPECTIVE");
  if (light.type == LightType::point) defines.emplace_back("CUBE");
  if (view.reversed) defines.emplace_back("REVERSED");
  return defines;
}

TechniqueShader technique_shader(const MapOptions& options, const Light& light) {
  switch (options.technique) {
    case Technique::pcf:
      return pcf_shader(options.filter);
    case Technique::pcss:
      return pcss_shader(options.filter, light);
    case Technique::vsm:
    case Technique::esm:
    case Technique::evsm:
    case Technique::msm:
      return moment_technique(options, light);
    case Technique::hybrid:
      return {"external", {"EXTERNAL"}};
    case Technique::izb:
      return {"izb", {}};
    case Technique::csm:
      return options.cascades.blend > 0.0 ? TechniqueShader{"cascade_blend", {}} : TechniqueShader{};
    default:
      return {};  // the hard test
  }
}

std::unique_ptr<TechniquePass> make_technique_pass(Gl& gl, ProgramCache& programs, Technique technique) {
  if (uses_moments(technique)) return std::make_unique<MomentPass>(gl, programs);
  if (technique == Technique::midpoint) return std::make_unique<MidpointPass>(gl, programs);
  if (technique == Technique::izb) return std::make_unique<IzbPass>(gl, programs);
  return nullptr;
}

}  // namespace gnomon::raster
