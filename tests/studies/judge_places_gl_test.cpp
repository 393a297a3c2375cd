// What the numbers of places do to a capture: far from the origin, with a triangle that reaches absurdly far, and where a ray
// tracer's smooth normals face away.
#include <fmt/ranges.h>

#include "compare/result/judged.h"
#include "raytrace/shading/smooth_surface.h"
#include "scene/light.h"
#include "tests/support/capture_support.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using compare::Label;
using judge::Capture;

std::string all_notes(const JudgeOutcome& judged) {
  return judged.result ? fmt::format("{}", fmt::join(judged.result->judged->notes, "\n")) : reason(judged);
}

Scene moved_by(Scene scene, const Vec3& by) {
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p += by;
  scene.camera.eye += by, scene.camera.target += by;
  return scene;
}

TEST(JudgePlaces, FarFromTheOriginAreSaidToBeCoarse) {
  for (const double away : {0.0, 1e5}) {
    const Compared drawn =
        draw_scene(moved_by(scene_under("sun"), {away, 0.0, 0.0}), small_picture, hard_map(128));
    const Capture capture = self_capture(drawn, folder_for("far-places"), {.map = true});
    const std::string notes = all_notes(judge(capture, *drawn.scene));
    EXPECT_EQ(notes.find("places of 32 bits lie 0.0078 world units apart") != std::string::npos, away > 0.0)
        << notes;
  }
}

TEST(JudgePlaces, OfOneAbsurdTriangleAreNamedAndTheRestIsJudged) {
  const Scene sound = scene_under("sun");
  Scene broken = sound;
  // Below the floor, where it is neither seen nor casts, and one corner is far off.
  Mesh& mesh = broken.meshes.front();
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Vec3 below(0.0, -5.0, 0.0);
  mesh.positions.insert(mesh.positions.end(),
                        {below, below + Vec3(0.1, 0.0, 0.0), below + Vec3(0.0, -3e8, 0.0)});
  if (!mesh.normals.empty()) mesh.normals.resize(mesh.positions.size(), mesh.normals.front());
  mesh.triangles.push_back({first, first + 1, first + 2});
  const Compared drawn = draw_scene(sound, small_picture, hard_map(128));
  const Capture capture = self_capture(drawn, folder_for("absurd"), {.map = true});
  const JudgeOutcome plain = judge(capture, sound), judged = judge(capture, broken);
  ASSERT_TRUE(plain.result && judged.result) << reason(judged);
  EXPECT_EQ(all_notes(plain).find("absurdly far"), std::string::npos);
  const std::string notes = all_notes(judged);
  EXPECT_NE(notes.find("1 of "), std::string::npos) << notes;
  EXPECT_NE(notes.find("reaches absurdly far, up to 3e+08 world units"), std::string::npos) << notes;
  EXPECT_NE(notes.find(" %) reaches"), std::string::npos) << notes;
  EXPECT_EQ(judged.result->lights[0].error.wrong, plain.result->lights[0].error.wrong);
  EXPECT_EQ(judged.result->lights[0].pixels.compared, plain.result->lights[0].pixels.compared);
}

/// A coarse ball whose vertices have the smooth body's normals, on a floor.
Scene coarse_ball() {
  Mesh ball;
  ball.name = "ball";
  constexpr std::uint32_t around = 10, up = 6;
  for (std::uint32_t j = 0; j <= up; ++j)
    for (std::uint32_t i = 0; i <= around; ++i) {
      const double phi = 2.0 * pi * i / around, theta = pi * j / up;
      const Vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      ball.positions.push_back(n + Vec3(0.0, 1.2, 0.0));
      ball.normals.push_back(Vec3f(n));
    }
  for (std::uint32_t j = 0; j < up; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = j * (around + 1) + i, b = a + 1, c = a + around + 1, d = c + 1;
      if (j > 0) ball.triangles.push_back({a, c, b});
      if (j + 1 < up) ball.triangles.push_back({b, c, d});
    }
  Scene scene = sunlit_scene({floor_mesh(4, 4), ball}, {0.8, -0.6, -0.3});
  scene.camera = {{-1.0, 2.4, 4.5}, {0.0, 1.0, 0.0}, {0, 1, 0}, 0.6};
  return scene;
}

// Truth goes by the triangle; this ray tracer is dark where the smooth normal faces away from the light.
TEST(RayTracers, TheTerminatorIsNamed) {
  const Compared drawn = draw_scene(coarse_ball(), small_picture, hard_map(64));
  Capture capture = self_capture(drawn, folder_for("terminator"), {.positions = false});
  capture.kind = judge::RendererKind::ray_tracer;
  const Light& light = drawn.scene->lights[drawn.light().light];
  const raytrace::Tracer tracer(*drawn.world, raytrace::Accel::bvh);
  spoil(capture.visibility, [&](ChannelImage& image) {
    for (std::size_t i = 0; i < image.channels[0].values.size(); ++i) {
      const raytrace::SurfacePoint& point = drawn.result.raytraced.receiver.data[i];
      if (point.primitive == no_id) continue;
      const bool lit = !light_cannot_reach(light, point.position, point.normal) &&
                       tracer.centre_visibility(point, light) == raytrace::PointVisibility::lit;
      const Vec3 to_light = light_at(light, point.position).to_light;
      const bool faces = glm::dot(raytrace::shading_normal(*drawn.world, point), to_light) > 0.0;
      image.channels[0].values[i] = lit && faces ? 1.0f : 0.0f;
    }
  });
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::LightComparison& found = judged.result->lights[0];
  ASSERT_GT(found.error.wrong, 30u);
  EXPECT_GT(double(found.classes[static_cast<std::size_t>(Label::acne) - 1]),
            0.95 * double(found.error.wrong));
  EXPECT_NE(all_notes(judged).find("are the shadow terminator"), std::string::npos) << all_notes(judged);
}

}  // namespace
}  // namespace gnomon::test
