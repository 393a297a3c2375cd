// Textures of MTL materials: map_Kd, with map_d as its mask.
//   -s, -o, -clamp       of map_Kd place both (of map_d where it stands alone); v is turned over
//   map_d of one's own   the image's alpha channel where it is not opaque throughout; else its luminance, which MTL
//                        takes of maps that are numbers
//   map_d of map_Kd's    the image's alpha channel; a grey image without one is the mask itself
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/files/material_notes.h"
#include "scene/files/obj/mtl.h"
#include "scene/files/pictures/image_io.h"
#include "scene/load.h"

namespace gnomon {

/// Brings each texture into the scene once.
class ObjTextures {
 public:
  /// Names of files are relative to `folder`.
  ObjTextures(Scene& scene, MaterialNotes& notes, const std::string& folder, const LoadOptions& options)
      : scene_(scene), notes_(notes), folder_(folder), options_(options) {}

  /// Brings in what the materials name, decoded in parallel. A file that is not there is a note; one that cannot be
  /// read is an error.
  Expected<void> read(const std::vector<MtlMaterial>& materials);
  /// Gives the material what the one of this number named; what is not used of it is a note.
  void give(const MtlMaterial& from, std::size_t number, Material& material);

 private:
  /// What map_d finds in an image. Pictures in colours without an alpha channel that are map_Kd, too, are no masks:
  /// files name them as map_d and mean what is opaque.
  enum class Mask : std::uint8_t { none, alpha, grey };
  /// Paths of files that are there; empty: none.
  struct Files {
    std::string colours, mask;
    bool clamped = false;
    bool empty() const { return colours.empty() && mask.empty(); }
    bool has_mask_of_its_own() const { return !mask.empty() && mask != colours; }
    auto operator<=>(const Files&) const = default;
  };
  struct Made {
    Texture texture;
    Mask mask = Mask::none;
  };
  struct Known {
    std::uint32_t texture;
    Mask mask;
  };

  Expected<std::string> find_file(const std::string& name, const std::string& material,
                                  const std::string& statement);
  Expected<Files> find_files(const MtlMaterial& from);
  Expected<Made> make(const Files& files) const;

  Scene& scene_;
  MaterialNotes& notes_;
  const std::string& folder_;
  const LoadOptions& options_;
  std::vector<Files> files_;  ///< of each material
  std::map<Files, Known> known_;
};

// MTL materials of an OBJ file, mapped to ours. The mapping:
//   Kd, Ks, Ke      diffuse, specular, emission; a material without Kd is neutral grey
//   Ns              shininess, at least 1
//   d (or 1 - Tr)   below 1: transmission = 1 - d, with the index of refraction Ni
//   illum 3, 5, 7   mirror = the mean of Ks, as far as transmission leaves room
//   illum 4, 6, 7   glass: with d = 1, transmission = the mean of Tf
//   map_Kd, map_d   diffuse texture and mask (obj_textures.h)
// Other maps are noted as not used.

/// Appends the materials (and their textures) to the scene, in order.
Expected<void> add_obj_materials(Scene& scene, const std::vector<MtlMaterial>& materials,
                                 const std::string& folder, const LoadOptions& options);

}  // namespace gnomon
