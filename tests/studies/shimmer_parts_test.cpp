// The parts of a film of shadows: where camera and light stand, keys from a file, and who made a flip.
#include <fstream>
#include <nlohmann/json.hpp>

#include "compare/result/outputs.h"
#include "compare/result/result_schema.h"
#include "studies/shimmer/outputs.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/one_world.h"
#include "tests/support/places.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using compare::CameraPath;
using compare::Cause;
using compare::FilmTime;
using compare::LightPath;
using compare::Pose;
using compare::ShimmerPath;

constexpr double rounding = 1e-12;  // of a few turns in doubles

Pose boxes_pose() {
  const Scene scene = boxes_under_three_lights();
  return {scene.camera, scene.lights};
}

TEST(ShimmerPath, OrbitKeepsTheDistanceAndComesRound) {
  const Pose first = boxes_pose();
  ShimmerPath path;
  path.camera = CameraPath::orbit, path.light = LightPath::orbit;
  const FilmTime time{37, 1.0};  // 36 seconds at 10 degrees
  const Vec3 centre(0.1, 0.2, 0.3);
  const double distance = glm::length(first.camera.eye - first.camera.target);
  for (const int frame : {5, 18}) {
    const Pose pose = pose_at(path, time, first, centre, frame);
    EXPECT_NEAR(glm::length(pose.camera.eye - pose.camera.target), distance, rounding);
    EXPECT_NEAR(pose.camera.eye.y, first.camera.eye.y, rounding);
    EXPECT_GT(glm::length(pose.camera.eye - first.camera.eye), 1.0);
    EXPECT_NEAR(glm::length(pose.lights[1].position - centre), glm::length(first.lights[1].position - centre),
                rounding);
  }
  EXPECT_NEAR(glm::length(pose_at(path, time, first, centre, 36).camera.eye - first.camera.eye), 0.0, 1e-11);
  EXPECT_EQ(pose_at(path, time, first, centre, 0).lights, first.lights);
}

TEST(ShimmerPath, TheScenesSunStandsAtNoon) {
  const Pose first = boxes_pose();
  ShimmerPath path;
  path.camera = CameraPath::still, path.light = LightPath::sun;
  const FilmTime time{11, 30.0};
  const Pose noon = pose_at(path, time, first, {}, 5);
  EXPECT_NEAR(glm::length(noon.lights[0].direction - first.lights[0].direction), 0.0, rounding);
  EXPECT_EQ(noon.camera, first.camera);
  const Vec3 rising = pose_at(path, time, first, {}, 0).lights[0].direction;
  const Vec3 setting = pose_at(path, time, first, {}, 10).lights[0].direction;
  EXPECT_NEAR(glm::dot(rising, setting), std::cos(170.0 * pi / 180.0), rounding);
  EXPECT_EQ(noon.lights[1], first.lights[1]);  // lamps have no day
}

TEST(ShimmerPath, KeysAreMetAndStepsStand) {
  KeyedVector keys{Interpolation::cubic, {0.0, 1.0, 3.0}, {{0, 0, 0}, {1, 2, 0}, {4, 2, 1}}};
  for (std::size_t i = 0; i < keys.times.size(); ++i)
    EXPECT_NEAR(glm::length(keys.at(keys.times[i]) - keys.values[i]), 0.0, rounding);
  // Keys on a line, evenly in time: so is the curve.
  const KeyedVector line{Interpolation::cubic, {0.0, 1.0, 3.0}, {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}};
  EXPECT_NEAR(line.at(2.2).x, 2.2, rounding);
  keys.interpolation = Interpolation::step;
  EXPECT_EQ(keys.at(2.9), keys.values[1]);
  keys.interpolation = Interpolation::linear;
  EXPECT_NEAR(keys.at(2.0).x, 2.5, rounding);
  EXPECT_EQ(keys.at(9.0), keys.values[2]);
}

std::string path_error(const std::string& text) {
  const std::string file = ::testing::TempDir() + "gnomon-shimmer-path.json";
  std::ofstream(file) << text;
  const auto read = read_path(file);
  return read ? std::string() : read.error().message();
}

TEST(ShimmerPath, BadFilesAreOneLine) {
  EXPECT_EQ(
      path_error(
          R"({"schema": "gnomon/path/1", "camera": {"eye": {"times": [0, 1], "values": [[0,0,1],[0,0,2]]}}})"),
      "");
  EXPECT_NE(path_error(R"({"schema": "gnomon/path/2"})").find("gnomon/path/1"), std::string::npos);
  EXPECT_NE(
      path_error(
          R"({"schema": "gnomon/path/1", "camera": {"eye": {"times": [1, 1], "values": [[0,0,1],[0,0,2]]}}})")
          .find("rise"),
      std::string::npos);
  EXPECT_NE(path_error(R"({"schema": "gnomon/path/1", "camera": {"eye": {"times": [0], "values": []}}})")
                .find("values"),
            std::string::npos);
  EXPECT_NE(
      path_error(
          R"({"schema": "gnomon/path/1", "lights": {"sun": {"direction": {"times": [0], "values": [[0,0,0]]}}}})")
          .find("no length"),
      std::string::npos);
}

// From east to west straight through no direction at all.
TEST(ShimmerPath, ADirectionThatPassesThroughZeroIsTold) {
  Pose pose = boxes_pose();
  ShimmerPath path;
  path.light = LightPath::keys;
  path.keys.lights[pose.lights[0].name].direction =
      KeyedVector{Interpolation::linear, {0.0, 2.0}, {{1.0, -0.5, 0.0}, {-1.0, 0.5, 0.0}}};
  FilmTime time;
  time.frames = 3, time.fps = 1.0;
  EXPECT_TRUE(compare::check_pose(pose_at(path, time, pose, Vec3(0.0), 0), 0));
  const auto half_way = compare::check_pose(pose_at(path, time, pose, Vec3(0.0), 1), 1);
  ASSERT_FALSE(half_way);
  EXPECT_NE(half_way.error().message().find("in frame 1 the light \"" + pose.lights[0].name),
            std::string::npos)
      << half_way.error().message();
}

// Rungs V0 … V6 before and after.
TEST(ShimmerFlip, HasTheLabelOfItsWrongEnd) {
  using Rungs = std::array<float, compare::rung_count>;
  const Rungs lit{1, 1, 1, 1, 1, 1, 1}, aliased{1, 1, 0, 0, 0, 0, 0}, cured_acne{1, 1, 1, 0, 0, 1, 1};
  EXPECT_EQ(studies::flip_cause(lit, aliased), Cause::sampling);
  EXPECT_EQ(studies::flip_cause(aliased, lit), Cause::sampling);
  // The acne that the bias cures is no part of what makes the shadow false in the next frame.
  EXPECT_EQ(studies::flip_cause(cured_acne, aliased), Cause::sampling);
  const Rungs acne{1, 1, 1, 0, 0, 0, 0}, leak{0, 0, 0, 0, 0, 1, 1};
  EXPECT_EQ(studies::flip_cause(acne, lit), Cause::slope);
  EXPECT_EQ(studies::flip_cause({0, 0, 0, 0, 0, 0, 0}, leak), Cause::bias);
  // Less than one half wrong at both ends.
  const Rungs darker{0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.125f},
      lighter{0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.875f};
  EXPECT_EQ(studies::flip_cause(darker, lighter), Cause::filter);
}

TEST(ShimmerJson, FitsItsSchema) {
  OneWorld one(boxes_under_three_lights());
  studies::ShimmerOptions options;
  options.compare.raster.size = {48, 32};
  options.compare.raster.map.size = 64;
  options.time.frames = 4;
  options.path.camera = CameraPath::drift;
  const auto film =
      studies::film_shimmer(one.world, one.scene, *one.renderer, every_light(one.scene), options);
  ASSERT_TRUE(film);
  const auto json = nlohmann::json::parse(studies::shimmer_json(*film, {"gnomon shimmer", 0, 1.0}));
  std::ifstream schema(source_dir() + "/studies/shimmer/shimmer.schema.json");
  for (const std::string& violation : SchemaCheck(nlohmann::json::parse(schema)).violations(json))
    ADD_FAILURE() << violation;
  ASSERT_EQ(json["lights"].size(), 3u);
  std::uint64_t flips = 0;
  for (const auto& step : json["lights"][0]["by_frame"]) flips += step["flips"].get<std::uint64_t>();
  EXPECT_EQ(flips, json["lights"][0]["flips"]);
  EXPECT_EQ(json["lights"][0]["by_frame"].size(), 3u);
  EXPECT_EQ(json["lights"][1]["flips"], 0);  // a lamp's map stays with the lamp
}

// The cascades share the compared and the wrong pixels out among themselves, and the budget with them.
TEST(CascadeBudgets, AddUpToTheLights) {
  OneWorld one(sunlit_scene({floor_mesh(20, 20), box_mesh({-0.5, 0.0, -0.5}, {0.5, 0.8, 0.5}),
                             box_mesh({2.0, 0.0, -9.0}, {3.0, 2.0, -8.0})},
                            {0.7, -1.0, 0.3}));
  one.scene.camera = {{0.5, 1.5, 5.0}, {0.5, 0.5, 0.0}, {0, 1, 0}, 0.9};
  compare::CompareOptions options;
  options.raster.size = options.raytrace.size = {192, 128};
  options.raster.map.size = 128;
  options.raster.map.technique = raster::Technique::csm;
  options.raster.runs = 1;
  const auto json = nlohmann::json::parse(compare::result_json(one.compare(options)));
  for (const std::string& violation : SchemaCheck(compare::result_schema()).violations(json))
    ADD_FAILURE() << violation;
  const auto& light = json["lights"][0];
  ASSERT_EQ(light["by_cascade"].size(), 4u);
  std::uint64_t compared = 0, wrong = 0;
  double bias = 0.0;
  for (const auto& cascade : light["by_cascade"]) {
    compared += cascade["compared"].get<std::uint64_t>(), wrong += cascade["wrong"].get<std::uint64_t>();
    bias += cascade["budget"][4]["signed"].get<double>() * cascade["compared"].get<double>();
  }
  EXPECT_EQ(compared, light["pixels"]["compared"]);
  EXPECT_EQ(wrong, light["error"]["wrong"]);
  EXPECT_GT(wrong, 0u);
  EXPECT_GT(light["by_cascade"][0]["compared"], 0);
  // Sums of whole numbers, as the drawing is hard, rounded when they are divided.
  EXPECT_NEAR(bias / double(compared), light["budget"][4]["signed"].get<double>(), 1e-12);
}

// Receivers on a plane, whose neighbours to the right and below lie `right` and `down` away.
studies::ReceiverSpacing plane_spacing(ImageSize size, const Vec2& right, const Vec2& down) {
  const auto all = [&](double value) {
    Image<float> out(size, static_cast<float>(value));
    for (int k = 0; k < size.width; ++k) out.at(k, size.height - 1) = out.at(size.width - 1, k) = 0.0f;
    return out;
  };
  return {all(glm::length(right)), all(glm::length(down)), all(right.x * down.y - right.y * down.x),
          all(glm::dot(right, down))};
}

// The mean speed, world units a frame, of a straight shadow edge with the unit normal `n` that moves along it by
// `speed` a frame, both in the plane.
double speed_of_edge(const Vec2& right, const Vec2& down, const Vec2& n, double speed) {
  const ImageSize size{160, 160};
  const int frames = 9;
  studies::TemporalBudget budget(size, frames, plane_spacing(size, right, down), 1);
  for (int frame = 0; frame < frames; ++frame) {
    studies::RungFrame rungs;
    const Image<std::uint8_t> none(size, 0);
    rungs.counted = Image<std::uint8_t>(size, 1), rungs.outside = rungs.face = none;
    Image<float> lit(size, 0.0f);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        lit.at(x, y) =
            glm::dot(n, double(x - 80) * right + double(y - 80) * down) < speed * (frame - 4) ? 1.0f : 0.0f;
    rungs.rungs.fill(lit);
    budget.add(std::move(rungs));
  }
  return budget.total().true_swept / budget.total().edge_length;
}

// 5 %: the estimate of the length is within 3 % on these grids (4.5 % on the sheared one), and pixels that are crossed whole
// leave the rest; in nine frames the edge passes a whole number of pixels of each grid.
TEST(ShimmerPath, SpeedOfAnEdgeDoesNotDependOnItsDirection) {
  struct Grid {
    const char* name;
    Vec2 right, down;
  };
  for (const Grid& grid :
       {Grid{"square", {1.0, 0.0}, {0.0, 1.0}}, Grid{"seen at a slant", {1.0, 0.0}, {0.0, 3.0}},
        Grid{"narrow", {2.0, 0.0}, {0.0, 1.0}}, Grid{"sheared", {1.0, 0.0}, {0.4, 1.2}}})
    for (int degrees = 0; degrees <= 180; degrees += 5) {
      const double angle = degrees * pi / 180.0, speed = 2.25;
      const Vec2 n(std::cos(angle), std::sin(angle));
      EXPECT_NEAR(speed_of_edge(grid.right, grid.down, n, speed) / speed, 1.0, 0.05)
          << grid.name << ", edge turned by " << degrees << " degrees";
    }
}

}  // namespace
}  // namespace gnomon::test
