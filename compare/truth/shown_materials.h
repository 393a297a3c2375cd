// Materials that the two pictures show differently: what mirrors or lets light through is matte grey to the
// rasterizer, and glass is opaque to the map and to the comparison. The page and the lab say so where it is looked at.
#pragma once

#include <string>
#include <vector>

#include "raster/frame.h"
#include "raytrace/tracer.h"

namespace gnomon::compare {

struct ShownMaterial {
  std::string name;
  float mirror = 0.0f, transmission = 0.0f;  ///< shares in [0, 1]
  bool is_glass() const { return transmission > 0.0f; }
};

class ShownMaterials {
 public:
  explicit ShownMaterials(const World& world);
  bool empty() const { return list_.empty(); }
  /// Some of them transmit.
  bool any_glass() const { return any_glass_; }
  const std::vector<ShownMaterial>& list() const { return list_; }
  /// The place in the list of what the primitive (or no_id) is made of, from 1 on; 0: of none of them.
  std::uint32_t of(std::uint32_t primitive) const;

 private:
  const World& world_;
  std::vector<std::uint32_t> place_;  ///< for each material of the scene
  std::vector<ShownMaterial> list_;
  bool any_glass_ = false;
};

/// By pixel, the place in that list of what the map stores in the texel that the pixel looks up. It is 0 unless that is
/// glass and not the pixel's own surface; empty where no material is glass.
Image<std::uint32_t> stored_glass(const raytrace::Tracer& tracer, const raster::LightRecord& record,
                                  const raster::MapOptions& options,
                                  const Image<raytrace::SurfacePoint>& receivers);

}  // namespace gnomon::compare
