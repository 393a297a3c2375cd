#include "raster/map_shape.h"

#include <fmt/format.h>

#include "raster/technique_traits.h"

namespace gnomon::raster {

bool has_map_for(Technique technique, LightType type) {
  return traits_of(technique).lights.has(type);
}

Expected<void> check_light(Technique technique, const Light& light) {
  if (has_map_for(technique, light.type)) return {};
  constexpr std::string_view types[] = {"directional", "point", "spot"};
  const bool cube = technique == Technique::cube;
  Error error{ErrorKind::usage,
              fmt::format("is made for {} lights alone (got the {} light {}, allowed there {}); --light "
                          "chooses one",
                          cube ? "point" : "directional", types[static_cast<std::size_t>(light.type)],
                          light.name, cube ? "hard, pcf, izb" : "hard, pcf, cube (point lights), izb")};
  error.field = fmt::format("technique {}", technique_name(technique));
  return fail(std::move(error));
}

bool fits_to_samples(const MapOptions& options) {
  return options.technique == Technique::csm && options.cascades.fit_samples;
}

Expected<LightView> fit_map(const World& world, const Light& light, double aspect, const MapOptions& options,
                            std::span<const Vec3> visible) {
  const Camera& camera = world.scene->camera;
  auto view = options.technique == Technique::csm
                  ? fit_cascades(world, light, camera, aspect, options.size, options.cascades, visible)
              : options.technique == Technique::lispsm
                  ? fit_warped(world, light, camera, aspect, options.size)
                  : fit_light_view(world, light, camera, aspect, options.size);
  if (!view) return view;
  view->seamless = light.type == LightType::point;
  view->reversed = options.depth_format == DepthFormat::d32f_reversed;
  return view;
}

std::vector<std::string> map_defines(const MapOptions& options) {
  std::vector<std::string> defines;
  if (options.technique == Technique::csm) defines.emplace_back("CASCADES");
  if (options.technique == Technique::lispsm) defines.emplace_back("WARP");
  if (options.depth_format == DepthFormat::d32f_reversed) defines.emplace_back("REVERSED");
  if (scales_bias(options)) defines.emplace_back("TEXEL_BIAS");
  if (options.bias.adaptive) defines.emplace_back("ADAPTIVE_BIAS");
  return defines;
}

}  // namespace gnomon::raster
