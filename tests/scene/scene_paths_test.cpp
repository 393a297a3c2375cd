// Paths by keys: animations of a glTF file against closed forms, and those of a scene in the project's own format.
#include "scene/keyed_path.h"
#include "tests/support/gltf_support.h"

namespace gnomon::gltf_test {
namespace {

constexpr double rounding = 1e-6;  // the file's floats, of numbers below 10

Json sampler(int input, int output, const char* interpolation) {
  return {{"input", input}, {"output", output}, {"interpolation", interpolation}};
}
Json channel(int index, int node, const char* path) {
  return {{"sampler", index}, {"target", {{"node", node}, {"path", path}}}};
}

// A camera below a dolly that turns, and a lamp: the dolly's rotation is linear and takes the shorter arc from a
// quaternion to the negative of its neighbour; the camera rides on a cubic spline with tangents of its own; the lamp
// jumps.
Builder animated() {
  Builder b = simple();
  b.json["cameras"] =
      Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}});
  b.json["extensionsUsed"] = {"KHR_lights_punctual"};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] =
      Json::array({{{"type", "spot"}, {"name", "lamp"}, {"intensity", 5.0}, {"spot", Json::object()}}});
  b.json["nodes"].push_back({{"name", "dolly"}, {"children", {2}}, {"translation", {1, 0, 0}}});
  b.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
  b.json["nodes"].push_back({{"name", "lamp"},
                             {"translation", {0, 4, 0}},
                             {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  b.json["scenes"][0]["nodes"] = {0, 1, 3};
  const float half = std::sqrt(0.5f);  // a quarter of a turn about y, given as its negative
  const int two = b.accessor(std::vector<float>{1, 3}, 5126, "SCALAR", 1);
  const int three = b.accessor(std::vector<float>{0, 1, 2}, 5126, "SCALAR", 1);
  const int turn = b.accessor(std::vector<float>{0, 0, 0, 1, 0, -half, 0, -half}, 5126, "VEC4", 4);
  const int ride =
      b.accessor(std::vector<float>{9, 9, 9, 0, 1, 5, 0, 2, 0, 3, 0, 0, 0, 1, 3, 9, 9, 9}, 5126, "VEC3", 3);
  const int jump = b.accessor(std::vector<float>{0, 4, 0, 1, 4, 0, 2, 4, 0}, 5126, "VEC3", 3);
  b.json["animations"] = Json::array(
      {{{"name", "flight"},
        {"samplers",
         {sampler(two, turn, "LINEAR"), sampler(two, ride, "CUBICSPLINE"), sampler(three, jump, "STEP")}},
        {"channels",
         {channel(0, 1, "rotation"), channel(1, 2, "translation"), channel(2, 3, "translation"),
          channel(2, 0, "translation")}}}});
  return b;
}

Expected<Scene> load_with(const std::string& path, std::vector<KeyedPath>& paths) {
  LoadOptions options;
  options.paths = &paths;
  return load_scene(path, options);
}

TEST_F(Gltf, AnimationsOfCamerasAndLightsFollowTheirClosedForms) {
  std::vector<KeyedPath> paths;
  const auto scene = load_with(folder_.put("animated.gltf", animated().text()), paths);
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].name, "flight");
  EXPECT_EQ(paths[0].seconds(), 3.0);
  EXPECT_EQ(paths[0].objects_until, 2.0);
  for (const double t : {0.0, 1.0, 1.25, 2.0, 2.9, 3.0, 7.0}) {
    const double s = std::clamp((t - 1.0) / 2.0, 0.0, 1.0), s2 = s * s, s3 = s2 * s;
    // glTF 2.0, appendix C, with two seconds between the keys.
    const Vec3 from(0, 1, 5), out_of(0, 2, 0), into(3, 0, 0), to(0, 1, 3);
    const Vec3 ride = (2 * s3 - 3 * s2 + 1) * from + 2.0 * (s3 - 2 * s2 + s) * out_of +
                      (3 * s2 - 2 * s3) * to + 2.0 * (s3 - s2) * into;
    const double angle = 0.5 * pi * s;  // and not three quarters the other way
    const auto turned = [angle](const Vec3& v) {
      return Vec3(std::cos(angle) * v.x + std::sin(angle) * v.z, v.y,
                  std::cos(angle) * v.z - std::sin(angle) * v.x);
    };
    const Camera camera = paths[0].camera_at(scene->camera, t);
    EXPECT_LT(glm::length(camera.eye - (Vec3(1, 0, 0) + turned(ride))), rounding) << t;
    EXPECT_LT(glm::length(glm::normalize(camera.target - camera.eye) - turned(Vec3(0, 0, -1))), rounding)
        << t;
    EXPECT_LT(glm::length(camera.up - Vec3(0, 1, 0)), rounding) << t;
    const Light lamp = paths[0].light_at(scene->lights[0], t);
    EXPECT_LT(glm::length(lamp.position - Vec3(t < 1.0 ? 0 : t < 2.0 ? 1 : 2, 4, 0)), rounding) << t;
    EXPECT_LT(glm::length(lamp.direction - Vec3(0, 0, -1)), rounding) << t;
  }
}

// The mesh's node jumps with the lamp's keys; what is stored is left where no animation is asked for.
TEST_F(Gltf, ObjectsStandWhereTheAnimationPutsThem) {
  const std::string path = folder_.put("animated.gltf", animated().text());
  for (const double t : {0.0, 0.9, 1.0, 1.7, 2.0, 9.0}) {
    const auto scene = load_scene(path, {.animation = "flight", .seconds = t});
    ASSERT_TRUE(scene) << scene.error().message();
    const Vec3 at(scene->instances[0].world_from_object[3]);
    EXPECT_EQ(at, Vec3(t < 1.0 ? 0 : t < 2.0 ? 1 : 2, 4, 0)) << t;
  }
  const auto stored = load_scene(path);
  ASSERT_TRUE(stored);
  EXPECT_EQ(Vec3(stored->instances[0].world_from_object[3]), Vec3(0.0));
  const auto unknown = load_scene(path, {.animation = "fall", .seconds = 0.0});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message().find("no animation is called fall"), std::string::npos);
}

// A skin's vertices follow a joint that the animation moves: they are moved, and the path knows that objects are.
TEST_F(Gltf, SkinsFollowTheirJoints) {
  Builder b = simple();
  const std::vector<std::uint8_t> joints(16, 0);
  std::vector<float> weights(16, 0.0f);
  for (std::size_t i = 0; i < 4; ++i) weights[4 * i] = 1.0f;
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = b.accessor(joints, 5121, "VEC4", 4);
  attributes["WEIGHTS_0"] = b.accessor(weights, 5126, "VEC4", 4);
  b.json["nodes"].push_back({{"name", "bone"}});
  b.json["nodes"][0]["skin"] = 0;
  b.json["skins"] = Json::array({{{"joints", {1}}}});
  b.json["scenes"][0]["nodes"] = {0, 1};
  const int times = b.accessor(std::vector<float>{0, 4}, 5126, "SCALAR", 1);
  const int way = b.accessor(std::vector<float>{0, 0, 0, 8, 0, 4}, 5126, "VEC3", 3);
  b.json["animations"] = Json::array(
      {{{"samplers", {sampler(times, way, "LINEAR")}}, {"channels", {channel(0, 1, "translation")}}}});
  const std::string path = folder_.put("skinned.gltf", b.text());
  std::vector<KeyedPath> paths;
  const auto stored = load_with(path, paths);
  ASSERT_TRUE(stored) << stored.error().message();
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].name, "animation-0");
  EXPECT_EQ(paths[0].objects_until, 4.0);
  EXPECT_FALSE(paths[0].moves_camera());
  const auto later = load_scene(path, {.animation = "animation-0", .seconds = 1.0});
  ASSERT_TRUE(later) << later.error().message();
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT(glm::length(later->meshes[0].positions[i] - stored->meshes[0].positions[i] - Vec3(2, 0, 1)),
              rounding);
}

TEST_F(Gltf, MistakesInAnimationsHaveTheirPath) {
  const auto mistake = [&](const auto& change) {
    Builder b = animated();
    change(b.json["animations"][0]);
    std::vector<KeyedPath> paths;
    const auto scene = load_with(folder_.put("wrong.gltf", b.text()), paths);
    return scene ? std::string("it loaded") : scene.error().message();
  };
  EXPECT_NE(
      mistake([](Json& a) { a["channels"][0]["sampler"] = 3; }).find("animations[0].channels[0].sampler"),
      std::string::npos);
  EXPECT_NE(mistake([](Json& a) { a["samplers"][0]["interpolation"] = "CUBIC"; }).find("interpolation"),
            std::string::npos);
  EXPECT_NE(mistake([](Json& a) { a["samplers"][1]["interpolation"] = "LINEAR"; }).find("does not fit input"),
            std::string::npos);
  EXPECT_NE(mistake([](Json& a) { a["channels"][0]["target"]["path"] = "scale"; }).find("numbers each"),
            std::string::npos);
  EXPECT_EQ(mistake([](Json& a) { a["channels"][0]["target"].erase("node"); }), "it loaded");
}

TEST_F(Gltf, APathInASceneOfItsOwnFormat) {
  const auto scene = [](const std::string& path) {
    return R"({"schema": "gnomon/scene/1", "materials": [{"name": "m"}],
      "shapes": [{"sphere": {"center": [0,0,0], "radius": 1}, "material": "m"}],
      "lights": [{"name": "sun", "type": "directional", "direction": [0,-1,0]}],
      "camera": {"eye": [0,0,9], "target": [0,0,0]}, "paths": [)" +
           path + "]}";
  };
  std::vector<KeyedPath> paths;
  const auto made =
      load_with(folder_.put("paths.json", scene(R"({"name": "by", "camera": {"eye": {"times": [0, 2],
      "values": [[0,0,9],[4,0,9]]}}, "lights": {"sun": {"direction": {"interpolation": "step", "times": [0, 1],
      "values": [[0,-1,0],[1,-1,0]]}}}})")),
                paths);
  ASSERT_TRUE(made) << made.error().message();
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].camera_at(made->camera, 0.5).eye, Vec3(1, 0, 9));
  EXPECT_EQ(paths[0].camera_at(made->camera, 0.5).target, Vec3(0, 0, 0));
  EXPECT_EQ(paths[0].light_at(made->lights[0], 0.5).direction, Vec3(0, -1, 0));
  EXPECT_LT(glm::length(paths[0].light_at(made->lights[0], 1.5).direction - glm::normalize(Vec3(1, -1, 0))),
            1e-12);
  const auto wrong =
      load_with(folder_.put("wrong.json", scene(R"({"name": "by", "lights": {"moon": {}}})")), paths);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message().find("no light \"moon\""), std::string::npos) << wrong.error().message();
}

}  // namespace
}  // namespace gnomon::gltf_test
