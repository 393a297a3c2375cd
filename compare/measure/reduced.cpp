#include "compare/measure/reduced.h"

#include <utility>

namespace gnomon::compare {
namespace {

constexpr std::size_t most_pixels = std::size_t{1} << 23;  // of a page: 4096 x 2048

}  // namespace

int image_step(const ImageSize& picture) {
  int step = 1;
  const auto left = [&] {
    return ImageSize{(picture.width + step - 1) / step, (picture.height + step - 1) / step}.pixels();
  };
  while (left() > most_pixels) ++step;
  return step;
}

void append_reduced(raster::RasterFrame& to, const raster::RasterFrame& from, int first_row,
                    const Reduction& step) {
  append_reduced(to.color, from.color, first_row, step);
  append_reduced(to.primitive, from.primitive, first_row, step);
  if (to.lights.empty()) to.lights.resize(from.lights.size());
  for (std::size_t i = 0; i < from.lights.size(); ++i) {
    raster::LightRecord& light = to.lights[i];
    const raster::LightRecord& all = from.lights[i];
    append_reduced(light.texel_uv, all.texel_uv, first_row, step);
    append_reduced(light.face, all.face, first_row, step);
    append_reduced(light.distance, all.distance, first_row, step);
    append_reduced(light.gap, all.gap, first_row, step);
    if (!all.external || all.external->decision.data.empty()) continue;
    if (!light.external) light.external.emplace();
    append_reduced(light.external->decision, all.external->decision, first_row, step);
  }
}

void append_reduced(Climb& to, const Climb& from, int first_row, const Reduction& step) {
  for (std::size_t k = 0; k < rung_count; ++k) append_reduced(to.rungs[k], from.rungs[k], first_row, step);
  append_reduced(to.labels, from.labels, first_row, step);
}

void append_reduced(MetricMaps& to, const MetricMaps& from, int first_row, const Reduction& step) {
  append_reduced(to.edge_map, from.edge_map, first_row, step);
  append_reduced(to.flip_map, from.flip_map, first_row, step);
  append_reduced(to.ssim_map, from.ssim_map, first_row, step);
}

void append_reduced(Comparison& to, const raytrace::RayTracedFrame& from, int first_row,
                    const Reduction& step) {
  append_reduced(to.raytraced.color, from.color, first_row, step);
  append_reduced(to.seen, seen_surfaces(from.receiver), first_row, step);
}

Comparison reduced_images(const Comparison& whole, int every) {
  const Reduction step{every, whole.raster.options.size.height};
  Comparison out = whole;
  out.raster.color = {}, out.raster.primitive = {};
  for (raster::LightRecord& light : out.raster.lights) {
    light.texel_uv = {}, light.face = {}, light.distance = light.gap = {};
    if (light.external) light.external->decision = {};
  }
  out.raytraced.color = {}, out.raytraced.receiver = {};
  append_reduced(out.raster, whole.raster, 0, step);
  append_reduced(out, whole.raytraced, 0, step);
  for (std::size_t i = 0; i < out.lights.size(); ++i) {
    LightImages& light = out.lights[i];
    const LightImages all = std::exchange(light, {});
    append_reduced(static_cast<Climb&>(light), all, 0, step);
    append_reduced(static_cast<MetricMaps&>(light), all, 0, step);
    append_reduced(light.detachment_map, all.detachment_map, 0, step);
    append_reduced(light.stored_glass, all.stored_glass, 0, step);
  }
  return out;
}

}  // namespace gnomon::compare
