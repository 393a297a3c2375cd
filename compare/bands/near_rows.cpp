#include "compare/bands/near_rows.h"

namespace gnomon::compare {
namespace {

/// The map stays.
void forget_images_of(raster::LightRecord& record) {
  record.visibility = record.distance = record.gap = {};
  record.texel_uv = {};
  record.face = record.outside_map = {};
  record.lookups = {};
  record.external.reset();
}

}  // namespace

void NearRows::add(const raster::RasterFrame& band, const raytrace::RayTracedFrame& rays,
                   const std::vector<NearLight>& more) {
  if (drawn.lights.empty()) {
    drawn.options = band.options, drawn.context = band.context, drawn.custom_shader = band.custom_shader;
    for (const raster::LightRecord& record : band.lights) forget_images_of(drawn.lights.emplace_back(record));
    traced.options = rays.options;
    traced.lights.resize(rays.lights.size());
    for (std::size_t i = 0; i < rays.lights.size(); ++i) traced.lights[i].light = rays.lights[i].light;
    lights.resize(more.size());
  }
  append_rows(drawn.primitive, band.primitive, most_kept);
  append_rows(traced.receiver, rays.receiver, most_kept);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    raster::LightRecord& record = drawn.lights[i];
    append_rows(record.visibility, band.lights[i].visibility, most_kept);
    append_rows(record.texel_uv, band.lights[i].texel_uv, most_kept);
    append_rows(record.face, band.lights[i].face, most_kept);
    append_rows(lights[i].truth, more[i].truth, most_kept);
    append_rows(lights[i].drawn, more[i].drawn, most_kept);
    append_rows(lights[i].labels, more[i].labels, most_kept);
    append_rows(lights[i].climbed, more[i].climbed, most_kept);
  }
}

void NearRows::forget_images() {
  drawn.primitive = {};
  traced.receiver = {};
  for (std::size_t i = 0; i < lights.size(); ++i) {
    forget_images_of(drawn.lights[i]);
    lights[i] = {};
  }
}

void NearRows::forget_above(int row) {
  const int count = row - first_;
  if (count < spare) return;
  first_ = row;
  drop_rows(drawn.primitive, count);
  drop_rows(traced.receiver, count);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    raster::LightRecord& record = drawn.lights[i];
    drop_rows(record.visibility, count);
    drop_rows(record.texel_uv, count);
    drop_rows(record.face, count);
    drop_rows(lights[i].truth, count);
    drop_rows(lights[i].drawn, count);
    drop_rows(lights[i].labels, count);
    drop_rows(lights[i].climbed, count);
  }
}

}  // namespace gnomon::compare
