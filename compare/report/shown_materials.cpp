#include "compare/report/shown_materials.h"

namespace gnomon::compare {

ShownMaterials::ShownMaterials(const World& world) : world_(world) {
  for (const Material& m : world.scene->materials) {
    const bool is_shown = m.mirror > 0.0f || m.transmission > 0.0f;
    if (is_shown) list_.push_back({m.name, m.mirror, m.transmission});
    place_.push_back(is_shown ? static_cast<std::uint32_t>(list_.size()) : 0u);
    any_glass_ = any_glass_ || m.transmission > 0.0f;
  }
}

std::uint32_t ShownMaterials::of(std::uint32_t primitive) const {
  return primitive == no_id ? 0u : place_[world_.material_of(primitive)];
}

std::uint32_t ShownMaterials::stored_glass(const raster::LightRecord& record, std::size_t pixel,
                                           std::uint32_t primitive) const {
  const Vec2f at = glm::floor(record.texel_uv.data[pixel]);
  const auto size = static_cast<float>(record.map.view.size);
  if (!any_glass_ || primitive == no_id || !(at.x >= 0.0f && at.y >= 0.0f && at.x < size && at.y < size))
    return 0u;
  const std::uint32_t stored = record.map.primitive[record.map.texel_index(
      record.face.data[pixel], static_cast<int>(at.x), static_cast<int>(at.y))];
  const std::uint32_t place = stored == primitive ? 0u : of(stored);
  return place != 0u && list_[place - 1].is_glass() ? place : 0u;
}

}  // namespace gnomon::compare
