// Poses: angles in the scene files' sense, exact round trips, distances and aims kept.
#include "app/pose.h"

#include <gtest/gtest.h>

namespace gnomon::app {
namespace {

// A few roundings of numbers near 1; angles are in degrees, so a hundred times that.
constexpr double tolerance = 1e-14, degree_tolerance = 1e-12;

void expect_near(const Vec3& a, const Vec3& b, double bound = tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], bound) << "component " << i;
}

Light sun_towards(const Vec3& towards) {
  Light light;
  light.direction = -glm::normalize(towards);
  return light;
}

TEST(Pose, AzimuthAndElevationAreThoseOfSceneFiles) {
  const Light light = sun_towards({0.0, 1.0, 0.0});
  expect_near(posed_light(light, Vec3(0.0), {0.0, 0.0}).direction, {0.0, 0.0, -1.0});   // from +z
  expect_near(posed_light(light, Vec3(0.0), {90.0, 0.0}).direction, {-1.0, 0.0, 0.0});  // from +x
  expect_near(posed_light(light, Vec3(0.0), {17.0, 90.0}).direction, {0.0, -1.0, 0.0});
}

TEST(Pose, SunAngleReadsBackAsSet) {
  for (const LightPose pose : {LightPose{-122.0, 46.0}, LightPose{180.0, -30.0}, LightPose{0.25, 89.5}}) {
    const LightPose back = light_pose(posed_light(sun_towards({1.0, 2.0, 3.0}), Vec3(0.0), pose), Vec3(0.0));
    EXPECT_NEAR(back.azimuth_degrees, pose.azimuth_degrees, 100.0 * degree_tolerance);  // near the pole
    EXPECT_NEAR(back.elevation_degrees, pose.elevation_degrees, degree_tolerance);
  }
}

TEST(Pose, CameraComesBackToWhereItWas) {
  Camera camera;
  camera.eye = {0.4, 3.0, 5.6};
  camera.target = {0.05, 0.12, 0.2};
  const Camera same = posed_camera(camera, camera_pose(camera));
  expect_near(same.eye, camera.eye, 10.0 * tolerance);
  EXPECT_EQ(same.target, camera.target);
}

TEST(Pose, CameraTurnsAboutItsOwnUpVector) {
  Camera camera;
  camera.up = {0.0, 0.0, 2.0};  // z up, not unit length
  camera.target = {1.0, 1.0, 1.0};
  camera.eye = {4.0, 1.0, 1.0};
  for (const double azimuth : {-150.0, 0.0, 33.0}) {
    CameraPose pose = camera_pose(camera);
    pose.azimuth_degrees = azimuth;
    const Camera turned = posed_camera(camera, pose);
    EXPECT_NEAR(turned.eye.z, 1.0, tolerance * 10.0);
    EXPECT_NEAR(glm::length(turned.eye - camera.target), 3.0, tolerance * 10.0);
  }
}

TEST(Pose, CameraWithUpAlongXHasAFrame) {
  Camera camera;
  camera.up = {1.0, 0.0, 0.0};
  camera.eye = {0.0, 0.0, 5.0};
  expect_near(posed_camera(camera, camera_pose(camera)).eye, camera.eye, 10.0 * tolerance);
}

TEST(Pose, SpotKeepsDistanceAndAim) {
  Light spot;
  spot.type = LightType::spot;
  const Vec3 centre{1.0, 0.0, -2.0};
  spot.position = {4.0, 4.0, -2.0};
  spot.direction = glm::normalize(centre - spot.position);  // at the centre
  LightPose resized = light_pose(spot, centre);
  resized.size = 0.5;
  const Light larger = posed_light(spot, centre, resized);
  EXPECT_EQ(larger.direction, spot.direction) << "a new size turns nothing, not even by rounding";
  EXPECT_EQ(larger.position, spot.position);
  EXPECT_EQ(light_size(larger), 0.5);
  const Light turned = posed_light(spot, centre, {123.0, 20.0});
  EXPECT_NEAR(glm::length(turned.position - centre), 5.0, 10.0 * tolerance);
  expect_near(turned.direction, glm::normalize(centre - turned.position), 10.0 * tolerance);
  spot.direction = {0.0, -1.0, 0.0};  // past the centre: the angle to it stays
  const Light past = posed_light(spot, centre, {123.0, 20.0});
  EXPECT_NEAR(glm::dot(past.direction, glm::normalize(centre - past.position)),
              glm::dot(spot.direction, glm::normalize(centre - spot.position)), 10.0 * tolerance);
}

TEST(Pose, ALightTakesAnotherSizeAndKeepsItsShape) {
  const Light sun = posed_light(sun_towards({1.0, 2.0, 3.0}), Vec3(0.0), {10.0, 20.0, {}, 1.5});
  EXPECT_NEAR(std::get<SunDisc>(sun.extent).angular_diameter, 1.5 * pi / 180.0, tolerance);
  EXPECT_NEAR(light_size(sun), 1.5, degree_tolerance);
  Light lamp;
  lamp.type = LightType::point;
  lamp.position = {0.0, 3.0, 0.0};
  EXPECT_EQ(std::get<SphereLight>(resized_light(lamp, 0.25).extent).radius, 0.25);
  lamp.extent = RectangleLight{{3.0, 0.0, 0.0}, {0.0, 0.0, 4.0}};
  EXPECT_EQ(light_size(lamp), 5.0);
  expect_near(std::get<RectangleLight>(resized_light(lamp, 10.0).extent).half_height, {0.0, 0.0, 8.0});
  lamp.extent = DiscLight{1.0, {0.0, -1.0, 0.0}};
  expect_near(std::get<DiscLight>(resized_light(lamp, 0.5).extent).normal, {0.0, -1.0, 0.0});
  EXPECT_EQ(light_size(resized_light(lamp, 0.5)), 0.5);
}

TEST(Pose, AnotherUpVectorIsWhatTheCameraTurnsAbout) {
  Camera camera;
  camera.eye = {0.0, 0.0, 5.0};
  Camera meant = camera;
  meant.eye = {0.0, 5.0, 0.0};
  meant.up = {1.0, 0.0, 0.0};
  CameraPose pose = camera_pose(meant);
  pose.up = meant.up;
  const Camera posed = posed_camera(camera, pose);
  expect_near(posed.eye, meant.eye, 10.0 * tolerance);
  EXPECT_EQ(posed.up, meant.up);
}

TEST(Pose, DegreesWrapIntoOneTurn) {
  EXPECT_EQ(wrapped_degrees(180.0), 180.0);
  EXPECT_EQ(wrapped_degrees(-180.0), 180.0);
  EXPECT_EQ(wrapped_degrees(190.0), -170.0);
  EXPECT_EQ(wrapped_degrees(-725.0), -5.0);
  EXPECT_EQ(wrapped_degrees(540.0), 180.0);
}

}  // namespace
}  // namespace gnomon::app
