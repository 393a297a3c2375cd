// A world that keeps its instances is drawn as the same world flattened, to the last bit: pictures, primitives, maps and
// what the analysis reads back.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

Mesh with_normals(Mesh mesh) {
  for (const Vec3& p : mesh.positions) {
    mesh.normals.emplace_back(glm::normalize(p + Vec3(0.01)));
    mesh.uvs.emplace_back(static_cast<float>(p.x + p.y), static_cast<float>(p.z));
  }
  return mesh;
}

/// Boxes turned, mirrored and stretched over a square; `away`: all of it, from the origin.
Scene boxes(const Vec3& away) {
  Scene scene;
  scene.meshes = {square_mesh(6.0), with_normals(box_mesh())};
  scene.materials.resize(3);
  scene.materials[1].specular = Vec3f(0.4f);
  scene.instances.push_back({"ground", 0, placed(away, 1.0), 0});
  for (int i = 0; i < 24; ++i) {
    const Vec3 place = away + Vec3(0.9 * (i % 6) - 2.2, 0.2 + 0.13 * i, 1.1 * (i / 6) - 2.0);
    const Vec3 size(i % 3 == 0 ? -0.7 : 0.4, 0.3 + 0.05 * i, 0.6);
    const Mat4 turn =
        glm::rotate(glm::translate(Mat4(1.0), place), 0.37 * i, glm::normalize(Vec3(i, 3.0, 1.0)));
    scene.instances.push_back({"box", 1, glm::scale(turn, size), static_cast<std::uint32_t>(1 + i % 2)});
  }
  scene.lights = {sun(Vec3(0.3, -1.0, 0.4))};
  scene.camera.eye = away + Vec3(1.0, 5.0, 9.0), scene.camera.target = away;
  return scene;
}

void expect_same(const Drawn& kept, const Drawn& flat) {
  ASSERT_TRUE(kept.world->keeps_instances());
  EXPECT_EQ(kept.frame.primitive.data, flat.frame.primitive.data);
  EXPECT_EQ(kept.frame.color.data, flat.frame.color.data);
  ASSERT_EQ(kept.frame.lights.size(), flat.frame.lights.size());
  for (std::size_t i = 0; i < flat.frame.lights.size(); ++i) {
    const raster::LightRecord &a = kept.light(i), &b = flat.light(i);
    EXPECT_EQ(a.visibility.data, b.visibility.data);
    EXPECT_EQ(a.texel_uv.data, b.texel_uv.data);
    EXPECT_EQ(a.gap.data, b.gap.data);
    EXPECT_EQ(a.distance.data, b.distance.data);
    EXPECT_EQ(a.map.depth, b.map.depth);
  }
}

TEST(KeptInstances, AreDrawnAsFlattenedOnes) {
  for (const Vec3& away : {Vec3(0.0), Vec3(1e5, -3e4, 2e5)}) {
    const Scene scene = boxes(away);
    expect_same(draw(scene, small_options(), InstanceChoice::keep),
                draw(scene, small_options(), InstanceChoice::flatten));
  }
}

// From among them: many are beside or behind the camera, or on other faces of a point light's cube, and are not drawn.
TEST(KeptInstances, ThatAreNotInViewChangeNothing) {
  Scene scene = boxes(Vec3(0.0));
  scene.lights.push_back(lamp(LightType::point, Vec3(0.1, 1.2, 0.3), Vec3(0.0, 0.0, 1.0)));
  scene.camera.eye = Vec3(-0.4, 0.9, 0.2), scene.camera.target = Vec3(3.0, 0.6, 1.0);
  expect_same(draw(scene, small_options(), InstanceChoice::keep),
              draw(scene, small_options(), InstanceChoice::flatten));
}

TEST(KeptInstances, WithHolesAndTexturesToo) {
  Scene scene = boxes(Vec3(0.0));
  Texture texture;
  texture.size = {2, 2};
  texture.texels = {{255, 200, 10, 255}, {10, 90, 250, 0}, {90, 10, 40, 0}, {250, 250, 240, 255}};
  scene.textures.push_back(texture);
  scene.materials[2].alpha_mode = AlphaMode::mask, scene.materials[2].diffuse_texture = 0;
  scene.materials[1].diffuse_texture = 0;
  scene.lights.push_back(lamp(LightType::point, Vec3(-3.0, 6.0, 2.0), Vec3(0.0)));
  expect_same(draw(scene, small_options(), InstanceChoice::keep),
              draw(scene, small_options(), InstanceChoice::flatten));
}

TEST(KeptInstances, AreRefusedByTheIrregularZBuffer) {
  const Scene scene = boxes(Vec3(0.0));
  const World world = make_world(scene, InstanceChoice::keep);
  auto renderer = raster::Renderer::create(software_context(), world, plan_effects(scene));
  ASSERT_TRUE(renderer) << renderer.error().message();
  raster::RasterOptions options = small_options();
  options.map.technique = raster::Technique::izb;
  const std::array<std::uint32_t, 1> lights{0};
  const auto frame = (*renderer)->render(options, lights);
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().message().find("--instances flatten"), std::string::npos)
      << frame.error().message();
}

}  // namespace
}  // namespace gnomon::test
