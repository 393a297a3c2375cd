// Textures of MTL materials: map_Kd, and map_d where it is of the same file, however the two are spelt.
//   -s, -o, -clamp  of map_Kd place both; v is turned over
//   map_d           the image's alpha channel as a mask; a grey image without one is the mask itself
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include "scene/load.h"

namespace tinyobj {
struct material_t;
}

namespace gnomon {

/// Brings each texture into the scene once.
class ObjTextures {
 public:
  /// Names of files are relative to `folder`.
  ObjTextures(Scene& scene, const std::string& folder, const LoadOptions& options)
      : scene_(scene), folder_(folder), options_(options) {}

  /// Gives the material what `from` names. A file that is not there and what is not used are notes; one that cannot
  /// be read is an error.
  Expected<void> add(const tinyobj::material_t& from, Material& material);

 private:
  /// What map_d finds in an image. Pictures in colours that have no alpha channel are no masks: files name them as
  /// map_d, too, and mean what is opaque.
  enum class Mask : std::uint8_t { none, alpha, grey };
  struct Known {
    std::uint32_t texture;
    Mask mask;
  };
  using Key = std::tuple<std::string, bool, bool>;  ///< path, clamped, cut out

  Expected<Known> find_or_read(const std::string& path, bool clamped, bool cut_out);
  bool is_cut_out(const tinyobj::material_t& from) const;

  Scene& scene_;
  const std::string& folder_;
  const LoadOptions& options_;
  std::map<Key, Known> known_;
};

}  // namespace gnomon
