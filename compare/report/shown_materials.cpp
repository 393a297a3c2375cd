#include "compare/report/shown_materials.h"

namespace gnomon::compare {

ShownMaterials::ShownMaterials(const World& world) : world_(world) {
  for (const Material& m : world.scene->materials) {
    const bool is_shown = m.mirror > 0.0f || m.transmission > 0.0f;
    if (is_shown) list_.push_back({{"name", m.name}, {"mirror", m.mirror}, {"transmission", m.transmission}});
    place_.push_back(is_shown ? static_cast<std::uint32_t>(list_.size()) : 0u);
    any_glass_ = any_glass_ || m.transmission > 0.0f;
  }
}

std::uint32_t ShownMaterials::of(std::uint32_t primitive) const {
  return primitive == no_id ? 0u : place_[world_.material_of(primitive)];
}

std::uint32_t ShownMaterials::glass_of(std::uint32_t primitive) const {
  if (primitive == no_id) return 0u;
  const std::uint32_t material = world_.material_of(primitive);
  return world_.scene->materials[material].transmission > 0.0f ? place_[material] : 0u;
}

}  // namespace gnomon::compare
