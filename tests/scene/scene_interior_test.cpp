// Closed rooms without a camera are looked at from inside, and lit there.
#include <fmt/format.h>

#include <algorithm>

#include "scene/load.h"
#include "tests/support/obj_box.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

using test::box;
using test::loaded;

const Vec3 low(-2.0, 0.0, -3.0), high(2.0, 2.5, 3.0);

bool is_inside(const Vec3& p) {
  return glm::clamp(p, low, high) == p;
}

TEST(Interior, ARoomIsSeenAndLitFromInside) {
  const Scene room = loaded(box(low, high, true));
  EXPECT_TRUE(is_inside(room.camera.eye));
  ASSERT_EQ(room.lights.size(), 1u);
  EXPECT_EQ(room.lights[0].type, LightType::point);
  EXPECT_TRUE(is_inside(room.lights[0].position));
  EXPECT_TRUE(room.shapes.empty());
  EXPECT_TRUE(test::has_note(room, " inside a closed room, "));
  EXPECT_TRUE(test::has_note(room, "a point light 'lamp'"));
}

TEST(Interior, TheEyeIsNotInTheFurniture) {
  // A wardrobe stands where the camera would.
  const Scene room = loaded(box(low, high, true) + box({-1.0, 0.0, 1.2}, {1.0, 2.0, 3.0}, false, -1, 8));
  EXPECT_TRUE(is_inside(room.camera.eye));
  const Vec3 e = room.camera.eye;
  EXPECT_FALSE(e.x > -1.0 && e.x < 1.0 && e.z > 1.2) << e.x << ", " << e.z;
}

TEST(Interior, WhatIsNoRoomIsSeenFromOutside) {
  EXPECT_FALSE(is_inside(loaded(box(low, high, false)).camera.eye)) << "a solid box";
  for (int side = 0; side < 6; ++side)
    EXPECT_FALSE(is_inside(loaded(box(low, high, true, side)).camera.eye)) << "open at side " << side;
}

// A Cornell box with a lid, whose walls are turned as its maker pleased, and a lamp in it.
TEST(Interior, WhatShinesInsideMakesARoom) {
  const TemporaryFolder folder;
  folder.put("lamp.mtl", "newmtl white\nKd 0.8 0.8 0.8\nnewmtl lamp\nKd 0 0 0\nKe 4 4 4\n");
  const std::string obj = "mtllib lamp.mtl\nusemtl white\n" + box(low, high, false) + "usemtl lamp\n" +
                          box({-0.3, 2.3, -0.3}, {0.3, 2.4, 0.3}, false, -1, 8);
  const auto scene = load_scene(folder.put("cornell.obj", obj));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_TRUE(is_inside(scene->camera.eye));
}

// Nor is a body a room because it glows.
TEST(Interior, AGlowingBodyIsSeenFromOutside) {
  const TemporaryFolder folder;
  folder.put("lamp.mtl", "newmtl lamp\nKd 0 0 0\nKe 4 4 4\n");
  const auto scene =
      load_scene(folder.put("cube.obj", "mtllib lamp.mtl\nusemtl lamp\n" + box(low, high, false)));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_FALSE(is_inside(scene->camera.eye));
}

}  // namespace
}  // namespace gnomon
