// Which bare models get a ground: those that bring no floor of their own.
#include <fmt/format.h>

#include "scene/load.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

bool gets_ground(const std::string& obj) {
  TemporaryFolder folder;
  const auto scene = load_scene(folder.put("m.obj", obj));
  EXPECT_TRUE(scene) << scene.error().message();
  if (!scene) return false;
  const bool made = test::has_note(*scene, "a grey ground at y = ");
  EXPECT_NE(made, scene->shapes.empty());
  return made;
}

constexpr const char* corners = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n";
constexpr const char* top_and_sides = "f 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

TEST(Ground, IsMadeForABoxWithItsBottomAndWithout) {
  EXPECT_TRUE(gets_ground(std::string(corners) + top_and_sides + "f 1 2 3 4\n"));
  EXPECT_TRUE(gets_ground(std::string(corners) + top_and_sides));
}

// Where a face in the lowest plane is seen from above, a ground in that plane would flicker with it.
TEST(Ground, LiesBelowABottomThatIsSeenFromAbove) {
  const auto lies_below = [](const std::string& obj) {
    TemporaryFolder folder;
    folder.put("glass.mtl", "newmtl glass\nd 0.2\nNi 1.5\n");
    const auto scene = load_scene(folder.put("m.obj", obj));
    EXPECT_TRUE(scene) << scene.error().message();
    const bool below = scene && test::has_note(*scene, "just below the model's lowest point");
    EXPECT_NE(below, scene && test::has_note(*scene, "touching the model's lowest point"));
    return below;
  };
  const std::string bottom = "f 1 2 3 4\n", closed = std::string(corners) + top_and_sides + bottom;
  EXPECT_FALSE(lies_below(closed));
  EXPECT_TRUE(lies_below(std::string(corners) + "f 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n" + bottom));
  EXPECT_TRUE(lies_below("mtllib glass.mtl\nusemtl glass\n" + closed));
}

TEST(Ground, IsMadeForASheetThatStands) {
  EXPECT_TRUE(gets_ground("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  EXPECT_TRUE(gets_ground("v 0 0 0\nv 1 0 0\nv 1 1 0.01\nv 0 1 0.01\nf 1 2 3 4\n"));
}

TEST(Ground, IsNotMadeUnderAFloorOrATerrain) {
  EXPECT_FALSE(gets_ground(std::string(corners) + top_and_sides +
                           "v -1 0 -1\nv 2 0 -1\nv 2 0 2\nv -1 0 2\nf 12 11 10 9\n"));
  EXPECT_FALSE(gets_ground("v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 4 3 2 1\n"));
  std::string hills;  // slopes of 45 degrees in the mean
  constexpr int n = 9;
  for (int z = 0; z < n; ++z)
    for (int x = 0; x < n; ++x) hills += fmt::format("v {} {} {}\n", x, (x + z) % 2, z);
  for (int z = 0; z + 1 < n; ++z)
    for (int x = 0; x + 1 < n; ++x) {
      const int a = z * n + x + 1;
      hills += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + n, a + n + 1, a, a + n + 1, a + 1);
    }
  EXPECT_FALSE(gets_ground(hills));
}

}  // namespace
}  // namespace gnomon
