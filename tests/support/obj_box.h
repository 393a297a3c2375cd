// Boxes and quads as OBJ text, of which tests of made cameras build their scenes.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "scene/load.h"
#include "scene/math.h"
#include "tests/support/scene_files_support.h"

namespace gnomon::test {

/// An OBJ box from `low` to `high`, its faces turned inwards or outwards; `without` leaves that side open (0 to
/// 5: -x, +x, -y, +y, -z, +z). `first` is the number of the vertex before it.
inline std::string box(const Vec3& low, const Vec3& high, bool inwards, int without = -1, int first = 0) {
  std::string out;
  for (int i = 0; i < 8; ++i)
    out += fmt::format("v {} {} {}\n", (i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y,
                       (i & 4) ? high.z : low.z);
  const int sides[6][4] = {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5},
                           {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}};
  for (int side = 0; side < 6; ++side) {
    if (side == without) continue;
    const auto& f = sides[side];
    const auto corner = [&](int i) { return first + f[inwards ? 3 - i : i]; };
    out += fmt::format("f {} {} {} {}\n", corner(0), corner(1), corner(2), corner(3));
  }
  return out;
}

/// A level OBJ rectangle, seen from above. `first` as of box().
inline std::string level(const Vec3& low, double x, double z, int first = 0) {
  return fmt::format("v {0} {1} {4}\nv {2} {1} {4}\nv {2} {1} {3}\nv {0} {1} {3}\nf {5} {6} {7} {8}\n", low.x,
                     low.y, x, low.z, z, first + 1, first + 2, first + 3, first + 4);
}

/// The scene of such a file, with the camera and light that are made for it.
inline Scene loaded(const std::string& obj) {
  const TemporaryFolder folder;
  auto scene = load_scene(folder.put("m.obj", obj));
  if (scene) return std::move(*scene);
  ADD_FAILURE() << scene.error().message();
  return {};
}

}  // namespace gnomon::test
