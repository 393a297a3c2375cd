// The built-in scenes: every name has a file, every file loads, and each is the scene that the lessons need.
#include <gtest/gtest.h>

#include <set>

#include "scene/load.h"
#include "scene/world.h"

namespace gnomon {
namespace {

TEST(BuiltinScenes, EveryNameHasAFileThatStartsWithAComment) {
  const auto scenes = builtin_scenes();
  ASSERT_EQ(scenes.size(), 17u);
  std::set<std::string_view> names;
  for (const BuiltinScene& s : scenes) {
    EXPECT_TRUE(names.insert(s.name).second);
    EXPECT_EQ(s.description.back(), '.') << s.name;
    const auto file = find_builtin_scene(s.name);
    ASSERT_TRUE(file) << s.name;
    EXPECT_EQ(file->text.substr(0, 3), "// ") << s.name;
    // The list's description is the file's own.
    EXPECT_NE(file->text.find(s.description), std::string_view::npos) << s.name;
  }
  for (const std::string_view name :
       {"acne-floor", "floating-box", "fence", "thin-wall", "whitted", "courtyard", "teapot", "stadium",
        "field", "far-away", "penumbra", "studio", "orchard", "wires"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  EXPECT_FALSE(find_builtin_scene("no-such-scene"));
  EXPECT_FALSE(find_builtin_scene(""));
}

TEST(BuiltinScenes, EveryOneLoadsWithNothingMadeUp) {
  for (const BuiltinScene& s : builtin_scenes()) {
    const Expected<Scene> scene = load_scene(std::string(s.name));
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(scene->name, s.name);
    EXPECT_FALSE(scene->lights.empty());
    EXPECT_TRUE(scene->notes.empty()) << s.name << ": " << scene->notes.front();
    EXPECT_TRUE(scene->exposure.has_value()) << s.name;
  }
}

std::uint32_t triangles(const std::string& name) {
  const Expected<Scene> scene = load_scene(name);
  return scene ? make_world(*scene).triangle_count() : 0;
}

TEST(BuiltinScenes, TriangleCounts) {
  EXPECT_EQ(triangles("acne-floor"), 2u);  // nothing but the floor
  EXPECT_EQ(triangles("thin-wall"), 14u);
  EXPECT_EQ(triangles("sphere-plane"), 0u);
  EXPECT_EQ(triangles("whitted"), 0u);
  EXPECT_GE(triangles("courtyard"), 20000u);
  EXPECT_LE(triangles("courtyard"), 90000u);
  EXPECT_GE(triangles("teapot"), 20000u);
  EXPECT_LE(triangles("fence"), 200000u);
}

TEST(BuiltinScenes, ThinWallIsWhatTheClosedFormNeeds) {
  const Expected<Scene> scene = load_scene("thin-wall");
  ASSERT_TRUE(scene);
  // The sun shines square to the wall: no z component; the wall is 0.05 thick, centred on x = 0, and stands
  // on y = 0.
  EXPECT_EQ(scene->lights[0].direction.z, 0.0);
  EXPECT_NEAR(scene->lights[0].direction.y, -0.5, 1e-15);  // 60 degrees from the floor's normal
  EXPECT_LT(scene->lights[0].direction.x, 0.0);
  const World world = make_world(*scene);
  Aabb wall;
  for (std::uint32_t t = 0; t < world.triangle_count(); ++t) {
    if (scene->instances[world.object_of(t)].name != "wall") continue;
    for (const Vec3& p : world.corners(t)) wall.grow(p);
  }
  EXPECT_DOUBLE_EQ(wall.min.x, -0.025);
  EXPECT_DOUBLE_EQ(wall.max.x, 0.025);
  EXPECT_EQ(wall.min.y, 0.0);
}

TEST(BuiltinScenes, TheOrchardIsOneTree) {
  const Expected<Scene> scene = load_scene("orchard");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->meshes.size(), 3u);  // bark, leaves, meadow
  EXPECT_EQ(scene->instances.size(), 2u * 225u + 1u);
}

}  // namespace
}  // namespace gnomon
