#include "raytrace/packet/compact.h"

namespace gnomon::raytrace {

void CompactTile::put(std::size_t lane, const SurfacePoint& point) {
  if (point.primitive == no_id) return;
  if (!any) origin = point.position, any = true;
  present[lane / packet_rays] |= static_cast<std::uint16_t>(1u << (lane % packet_rays));
  bounds.grow(point.position);
  for (int a = 0; a < 3; ++a) {
    position[a][lane] = static_cast<float>(point.position[a] - origin[a]);
    normal[a][lane] = static_cast<float>(point.normal[a]);
  }
  own[lane] = point.primitive;
}

void CompactTile::finish() {
  if (any) extent = max_component(glm::max(bounds.max - origin, origin - bounds.min));
}

}  // namespace gnomon::raytrace
