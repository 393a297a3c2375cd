// Material libraries (MTL) of OBJ files, read strictly: a number that is none is an error with its line and column.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"
#include "scene/math.h"

namespace gnomon {

/// A texture statement: the file and how it lies (v upwards): it is looked up at scale * (u, v) + offset.
struct MtlTexture {
  std::string file{};  ///< as written; empty: there is none
  Vec2 scale{1.0}, offset{0.0};
  bool clamped = false;
};

/// What a library says of a material, with the format's values for what it does not say.
struct MtlMaterial {
  std::string name;
  std::optional<Vec3> diffuse{};                          ///< Kd
  Vec3 specular{0.0}, emission{0.0}, transmittance{0.0};  ///< Ks, Ke, Tf
  double shininess = 1.0, ior = 1.0;                      ///< Ns, Ni
  double dissolve = 1.0;                                  ///< d, or 1 - Tr where there is no d; 1 is opaque
  int illum = 0;
  bool has_full_transparency = false;  ///< "Tr 1", which changes nothing
  MtlTexture colours{}, mask{};        ///< map_Kd, map_d
  std::set<std::string> other_maps{};  ///< statements of maps that are not used
};

struct MtlLibrary {
  std::vector<MtlMaterial>
      materials;                   ///< in the file's order; statements before the first `newmtl` say nothing
  std::vector<std::string> notes;  ///< options and statements that are not used
  std::set<std::string> warnings;  ///< statements that contradict each other
};

/// Names of files may hold blanks; names of materials have none at their ends. Where three numbers are allowed, one is a
/// grey; behind -s and -o the last two may be missing. `d -halo 0.5` (the more transparent, the more squarely it is seen)
/// is `d 0.5`. Error (bad_input): a number that is none, or too few of them.
Expected<MtlLibrary> parse_mtl(std::string_view text, const std::string& file);

}  // namespace gnomon
