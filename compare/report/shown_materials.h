// Materials that the two pictures show differently: what mirrors or lets light through is matte grey to the
// rasterizer, and glass is opaque to the map and to the comparison. The page says so where it is looked at.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "scene/world.h"

namespace gnomon::compare {

class ShownMaterials {
 public:
  explicit ShownMaterials(const World& world);
  bool empty() const { return list_.empty(); }
  /// Some of them transmit.
  bool any_glass() const { return any_glass_; }
  /// For the script: [{name, mirror, transmission}], shares in [0, 1].
  const nlohmann::ordered_json& list() const { return list_; }
  /// The place in the list of what the primitive (or no_id) is made of, from 1 on; 0: of none of them.
  std::uint32_t of(std::uint32_t primitive) const;
  /// The same, of glass alone.
  std::uint32_t glass_of(std::uint32_t primitive) const;

 private:
  const World& world_;
  std::vector<std::uint32_t> place_;  ///< for each material of the scene
  nlohmann::ordered_json list_ = nlohmann::ordered_json::array();
  bool any_glass_ = false;
};

}  // namespace gnomon::compare
