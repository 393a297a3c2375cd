#include "compare/measure/rows.h"

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

void NearRows::add(const Frames& band, const ImageSize& picture) {
  const auto& [drawn, traced] = band;
  whole_ = drawn.primitive.size == picture ? &band : nullptr;
  if (whole_ != nullptr) return;
  auto& [kept, rays] = window_;
  if (kept.lights.empty()) {
    kept.options = drawn.options, kept.context = drawn.context, kept.custom_shader = drawn.custom_shader;
    for (const raster::LightRecord& record : drawn.lights) forget_images_of(kept.lights.emplace_back(record));
    rays.options = traced.options;
    rays.lights.resize(traced.lights.size());
    for (std::size_t i = 0; i < traced.lights.size(); ++i) rays.lights[i].light = traced.lights[i].light;
    lights_.resize(drawn.lights.size());
  }
  append_rows(kept.primitive, drawn.primitive, most_kept);
  append_rows(rays.receiver, traced.receiver, most_kept);
  for (std::size_t i = 0; i < kept.lights.size(); ++i) {
    raster::LightRecord& record = kept.lights[i];
    append_rows(record.visibility, drawn.lights[i].visibility, most_kept);
    append_rows(record.texel_uv, drawn.lights[i].texel_uv, most_kept);
    append_rows(record.face, drawn.lights[i].face, most_kept);
  }
}

NearLight NearRows::add(std::size_t light, const Climb& climb, const Image<Label>& climbed) {
  if (whole_ != nullptr) return {climb.rungs.front(), climb.rungs.back(), climb.labels, climbed};
  LightRows& rows = lights_[light];
  append_rows(rows.truth, climb.rungs.front(), most_kept);
  append_rows(rows.drawn, climb.rungs.back(), most_kept);
  append_rows(rows.labels, climb.labels, most_kept);
  append_rows(rows.climbed, climbed, most_kept);
  return {rows.truth, rows.drawn, rows.labels, rows.climbed};
}

void NearRows::forget_images() {
  whole_ = nullptr;
  window_.drawn.primitive = {};
  window_.traced.receiver = {};
  for (raster::LightRecord& record : window_.drawn.lights) forget_images_of(record);
  lights_.clear();
}

void NearRows::forget_above(int row) {
  const int count = row - first_;
  if (count < spare) return;
  first_ = row;
  drop_rows(window_.drawn.primitive, count);
  drop_rows(window_.traced.receiver, count);
  for (raster::LightRecord& record : window_.drawn.lights) {
    drop_rows(record.visibility, count);
    drop_rows(record.texel_uv, count);
    drop_rows(record.face, count);
  }
  for (LightRows& light : lights_) {
    drop_rows(light.truth, count);
    drop_rows(light.drawn, count);
    drop_rows(light.labels, count);
    drop_rows(light.climbed, count);
  }
}

}  // namespace gnomon::compare
