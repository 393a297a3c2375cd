#include "compare/truth/shown_materials.h"

#include "compare/truth/stored_surface.h"
#include "compare/truth/texel_groups.h"
#include "scene/base/parallel.h"

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

Image<std::uint32_t> stored_glass(const raytrace::Tracer& tracer, const raster::LightRecord& record,
                                  const raster::MapOptions& options,
                                  const Image<raytrace::SurfacePoint>& receivers) {
  Image<std::uint32_t> out;
  const ShownMaterials materials(tracer.world());
  if (!materials.any_glass()) return out;
  out = Image<std::uint32_t>(receivers.size, 0u);
  parallel_for(receivers.data.size(), [&](std::size_t i) {
    const std::uint32_t own = receivers.data[i].primitive;
    raytrace::TexelKey key;
    if (own == no_id || !texel_of_pixel(record, i, key)) return;
    const std::uint32_t stored = stored_surface(tracer, record, options, key).primitive;
    const std::uint32_t place = stored == own ? 0u : materials.of(stored);
    if (place != 0u && materials.list()[place - 1].is_glass()) out.data[i] = place;
  });
  return out;
}

}  // namespace gnomon::compare
