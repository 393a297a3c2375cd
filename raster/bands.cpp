#include "raster/bands.h"

#include <algorithm>
#include <numeric>

#include "raster/gl_renderer.h"

namespace gnomon::raster {
namespace {

/// A band's costs hold the runs of those before it, too.
Times whole_of(const Times& runs) {
  return Times{{std::accumulate(runs.runs.begin(), runs.runs.end(), 0.0)}};
}

void add_external(const ExternalCosts& band, std::optional<ExternalCosts>& sum) {
  if (!sum) sum.emplace();
  sum->receivers += band.receivers, sum->penumbra += band.penumbra, sum->silhouette += band.silhouette;
  sum->surely_lit += band.surely_lit, sum->surely_shadowed += band.surely_shadowed;
  sum->rays += band.rays, sum->all_rays += band.all_rays;
  sum->triangle_tests += band.triangle_tests, sum->all_triangle_tests += band.all_triangle_tests;
  sum->bytes = std::max(sum->bytes, band.bytes);
  sum->build = band.build;
  sum->receivers_ms = whole_of(band.receivers_ms);
  sum->shadow = whole_of(band.shadow);
  sum->denoise = whole_of(band.denoise);
  sum->taps += band.taps;
  sum->boxes_per_ray = band.boxes_per_ray, sum->primitives_per_ray = band.primitives_per_ray;
}

/// What the first band knows of a light, and the others do not add to.
void append_light(const LightRecord& band, LightRecord& sum) {
  sum.light = band.light;
  sum.map.view = band.map.view, sum.map.format = band.map.format;
  sum.rounding = band.rounding;
  sum.bias_constant_world = band.bias_constant_world;
  sum.texel_world = band.texel_world, sum.rounding_world = band.rounding_world;
  sum.map_pass = band.map_pass, sum.map_texels = band.map_texels;
  sum.first_map_ms = band.first_map_ms;
}

}  // namespace

void set_rows(Renderer& renderer, const std::optional<PictureRows>& rows) {
  static_cast<GlRenderer&>(renderer).draw_rows(rows);  // the one kind that Renderer::create makes
}

std::size_t most_pixels(const Renderer& renderer, const MapOptions& map) {
  return static_cast<const GlRenderer&>(renderer).most_pixels(map);
}

void add_costs(const RasterFrame& band, RasterFrame& sum) {
  const bool first = sum.lights.empty();
  if (first) {
    sum.context = band.context, sum.options = band.options;
    sum.custom_shader = band.custom_shader;
    sum.upload_ms = band.upload_ms;
    sum.map_texels = band.map_texels;
    sum.lights.resize(band.lights.size());
  }
  for (const ReplacedShader& shader : band.replaced_shaders)
    if (std::find(sum.replaced_shaders.begin(), sum.replaced_shaders.end(), shader) ==
        sum.replaced_shaders.end())
      sum.replaced_shaders.push_back(shader);
  sum.read_back_ms += band.read_back_ms;
  sum.map_bytes = std::max(sum.map_bytes, band.map_bytes);
  for (std::size_t i = 0; i < sum.lights.size(); ++i) {
    const LightRecord& part = band.lights[i];
    LightRecord& light = sum.lights[i];
    if (first) append_light(part, light);
    light.shade_pass.add_part(part.shade_pass);
    light.unshadowed_pass.add_part(part.unshadowed_pass);
    light.strips.insert(light.strips.end(), part.strips.begin(), part.strips.end());
    if (part.external) add_external(*part.external, light.external);
  }
}

}  // namespace gnomon::raster
