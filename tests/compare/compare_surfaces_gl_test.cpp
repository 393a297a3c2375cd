// Both renderers on what glTF says of a surface: vertex colours, textures that glow, colours that no light changes, and
// sides that are not seen. The same primitives and the same radiance, but for single precision.
#include "raytrace/frame.h"
#include "scene/texture_sample.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

raytrace::RayTracedFrame traced(const Drawn& drawn) {
  const raytrace::Tracer tracer(*drawn.world, raytrace::Accel::bvh);
  raytrace::RaytraceOptions options;
  options.size = drawn.frame.options.size, options.picture = true;
  return trace_frame(tracer, plan_effects(*drawn.scene), drawn.scene->camera, std::vector<std::uint32_t>{0},
                     options);
}

struct Agreement {
  int pixels = 0;      ///< whose primitive and light are the same
  int primitives = 0;  ///< that differ
  float worst = 0.0f;  ///< difference of radiance
};

Agreement compare_both(const Drawn& drawn, const raytrace::RayTracedFrame& frame) {
  Agreement out;
  for (std::size_t i = 0; i < frame.color.data.size(); ++i) {
    const std::uint32_t primitive = frame.receiver.data[i].primitive;
    if (drawn.frame.primitive.data[i] != primitive) {
      ++out.primitives;
      continue;
    }
    const bool lit = frame.lights[0].centre.data[i] == raytrace::PointVisibility::lit;
    if (primitive != no_id && lit != (drawn.light().visibility.data[i] > 0.5f)) continue;
    ++out.pixels;
    const Vec3f difference = glm::abs(drawn.frame.color.data[i] - frame.color.data[i]);
    out.worst = std::max({out.worst, difference.x, difference.y, difference.z});
  }
  return out;
}

Texture stripes(int seed) {
  Texture texture;
  texture.size = {4, 4};
  for (int i = 0; i < 16; ++i) texture.texels.emplace_back(15 * i, 255 - seed * i, 40 * (i % 4), 255);
  return texture;
}

/// A ground with colours, a box that glows by a texture, and a square that no light changes above it.
Scene surfaces() {
  Scene scene;
  scene.materials.resize(3);
  scene.textures = {stripes(7), stripes(13)};
  scene.meshes = {square_mesh(3.0), box_mesh(), square_mesh(0.8)};
  for (int i = 0; i < 4; ++i)
    scene.meshes[0].colors.emplace_back(0.25f * static_cast<float>(i), 1.0f, 0.5f, 1.0f);
  for (const Vec3& p : scene.meshes[1].positions) scene.meshes[1].uvs.emplace_back(p.x + p.z, p.y - p.z);
  for (int i = 0; i < 4; ++i)
    scene.meshes[2].colors.emplace_back(1.0f, 0.3f * static_cast<float>(i), 0.7f, 1.0f);
  scene.materials[1].emission = Vec3f(0.5f, 2.0f, 1.0f);
  scene.materials[1].emission_texture = 1;
  scene.materials[1].emission_transform = {.offset = {0.1, 0.2}, .scale = {1.5, 0.75}, .rotation = 0.4};
  scene.materials[2].unlit = true;
  scene.materials[2].diffuse = Vec3f(0.9f, 0.8f, 0.7f);
  scene.materials[2].diffuse_texture = 0;
  scene.instances.push_back({"ground", 0, placed(Vec3(0.0), 1.0), 0});
  scene.instances.push_back({"box", 1, placed(Vec3(-1.2, 0.5, 0.0), 1.0), 1});
  scene.instances.push_back({"unlit", 2, placed(Vec3(1.0, 0.6, 0.0), 1.0), 2});
  scene.camera.eye = Vec3(1.5, 3.5, 4.0);
  scene.ambient = Vec3f(0.1f), scene.background = Vec3f(0.2f);
  scene.lights = {sun({-0.5, -1.0, -0.3})};
  return scene;
}

TEST(Surfaces, LookTheSameInBothRenderers) {
  const Drawn drawn = draw(surfaces());
  ASSERT_NE(drawn.renderer, nullptr);
  const raytrace::RayTracedFrame frame = traced(drawn);
  const Agreement both = compare_both(drawn, frame);
  EXPECT_LE(both.primitives, 5);  // ties of rounding at edges
  EXPECT_GT(both.pixels, 12000);  // the map has no bias: elsewhere it shadows itself
  EXPECT_LT(both.worst, 2e-4f);   // single precision of barycentric weights times colours up to 2
}

// The closed forms: of the first corner's colour, of the texture that glows, and of the colour without light.
TEST(Surfaces, ShowWhatTheyAreSaidToShow) {
  const Drawn drawn = draw(surfaces());
  ASSERT_NE(drawn.renderer, nullptr);
  const raytrace::RayTracedFrame frame = traced(drawn);
  const View view = drawn.view();
  std::array<int, 3> seen{};
  for (int y = 0; y < view.size.height; ++y)
    for (int x = 0; x < view.size.width; ++x) {
      const auto& point = frame.receiver.at(x, y);
      if (point.primitive == no_id) continue;
      const std::uint32_t object = drawn.world->object_of(point.primitive);
      const Vec3f color = frame.color.at(x, y);
      ++seen[object];
      const auto t = drawn.world->triangle(point.primitive);
      const Vec2 b = point.barycentric;
      const auto blended_color = [&] {
        const auto color_of = [&](std::size_t k) { return Vec3(Vec3f(drawn.world->color(t[k]))); };
        return (1.0 - b.x - b.y) * color_of(0) + b.x * color_of(1) + b.y * color_of(2);
      };
      if (object == 0) {  // ambient and light are white: the channels are in the colours' proportion
        const Vec3 expected = blended_color();
        ASSERT_NEAR(color.x * expected.y, color.y * expected.x, 1e-5);
        ASSERT_NEAR(color.z * expected.y, color.y * expected.z, 1e-5);
      }
      if (object == 2) {
        const Vec2 uv((point.position.x - 1.0 + 0.8) / 1.6, (point.position.z + 0.8) / 1.6);
        const Vec3 expected =
            Vec3(0.9, 0.8, 0.7) * Vec3(Vec3f(sample_texture(drawn.scene->textures[0], uv))) * blended_color();
        ASSERT_LT(glm::length(Vec3(color) - expected), 1e-5);
      }
    }
  for (const int count : seen) EXPECT_GT(count, 300);
}

/// An open box with one side, a mirror image of it, both sides of a sheet; the camera looks into them.
Scene sides() {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].double_sided = false;
  scene.materials[1].diffuse = Vec3f(0.8f, 0.3f, 0.2f);
  scene.meshes = {square_mesh(4.0), box_mesh(), square_mesh(0.7)};
  Mat4 mirrored = placed(Vec3(1.3, 0.6, 0.0), 1.0);
  mirrored[0] *= -1.0;
  Mat4 below = placed(Vec3(0.0, 1.8, 0.0), 1.0);
  below[1] *= -1.0, below[2] *= -1.0;  // turned over
  scene.instances = {{"ground", 0, placed(Vec3(0.0), 1.0), 0},
                     {"box", 1, placed(Vec3(-1.3, 0.6, 0.0), 1.0), 1},
                     {"mirrored", 1, mirrored, 1},
                     {"sheet", 2, below, 1}};
  scene.camera.eye = Vec3(0.7, 4.5, 4.0);
  scene.ambient = Vec3f(0.1f);
  scene.lights = {sun({-0.2, -1.0, -0.1})};
  return scene;
}

TEST(Sides, BothRenderersLookThroughTheSameBacks) {
  for (const bool turned : {false, true}) {  // boxes seen from outside, and inside out
    Scene scene = sides();
    if (turned)
      for (auto& t : scene.meshes[1].triangles) std::swap(t[1], t[2]);
    const Drawn drawn = draw(scene);
    ASSERT_NE(drawn.renderer, nullptr);
    const raytrace::RayTracedFrame frame = traced(drawn);
    const Agreement both = compare_both(drawn, frame);
    EXPECT_LE(both.primitives, 8) << "rounding at edges";
    EXPECT_LT(both.worst, 2e-4f);
    std::array<int, 4> seen{};
    int shadowed = 0;
    for (std::size_t i = 0; i < frame.color.data.size(); ++i) {
      const std::uint32_t primitive = frame.receiver.data[i].primitive;
      if (primitive == no_id) continue;
      const auto& point = frame.receiver.data[i];
      const std::uint32_t object = drawn.world->object_of(primitive);
      ++seen[object];
      if (object == 1 || object == 2) {
        // Of a box seen from outside the sides towards the eye are seen, inside out the others.
        const Vec3 outward = point.position - Vec3(object == 1 ? -1.3 : 1.3, 0.6, 0.0);
        ASSERT_EQ(glm::dot(outward, point.normal) > 0.0, !turned);
      }
      // The sheet faces down: it is not seen, and its shadow is.
      const bool below = std::abs(point.position.x + 0.36) < 0.6 && std::abs(point.position.z + 0.18) < 0.6;
      if (object == 0 && below)
        shadowed += frame.lights[0].centre.data[i] == raytrace::PointVisibility::shadowed &&
                            drawn.light().visibility.data[i] < 0.5f
                        ? 1
                        : 0;
    }
    EXPECT_EQ(seen[3], 0);
    EXPECT_GT(std::min({seen[0], seen[1], seen[2]}), 300);
    EXPECT_GT(shadowed, 300);
  }
}

// The alpha of vertex colours counts for masks: where it is below the cutoff there is no surface, in shadows either.
TEST(Surfaces, VertexAlphaMakesHoles) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].alpha_mode = AlphaMode::mask;
  scene.meshes = {square_mesh(4.0), square_mesh(1.5)};
  for (const float alpha : {0.0f, 1.0f, 1.0f, 0.0f})
    scene.meshes[1].colors.emplace_back(1.0f, 1.0f, 1.0f, alpha);
  scene.instances = {{"ground", 0, placed(Vec3(0.0), 1.0), 0},
                     {"sheet", 1, placed(Vec3(0.0, 1.0, 0.0), 1.0), 1}};
  scene.camera.eye = Vec3(1.5, 4.5, 4.0);
  scene.lights = {sun({-0.2, -1.0, -0.1})};
  raster::RasterOptions options = small_options(1024);
  options.map.bias.constant = 4.0;  // texels
  const Drawn drawn = draw(scene, options);
  ASSERT_NE(drawn.renderer, nullptr);
  const raytrace::RayTracedFrame frame = traced(drawn);
  int sheet = 0, shadowed = 0, wrong = 0;
  for (std::size_t i = 0; i < frame.color.data.size(); ++i) {
    const auto& point = frame.receiver.data[i];
    if (point.primitive == no_id) continue;
    const bool on_sheet = drawn.world->object_of(point.primitive) == 1;
    sheet += on_sheet ? 1 : 0;
    if (on_sheet) wrong += point.position.x > -1e-9 ? 0 : 1;  // alpha is x / 3 + 1 / 2
    const Vec3 under = point.position + Vec3(0.2, 1.0, 0.1);  // of the ground's points
    if (on_sheet || std::abs(under.x) < 0.05 || std::abs(std::abs(under.x) - 1.5) < 0.05 ||
        std::abs(std::abs(under.z) - 1.5) < 0.05)
      continue;
    const bool dark = under.x > 0.0 && under.x < 1.5 && std::abs(under.z) < 1.5;
    shadowed += dark ? 1 : 0;
    wrong += dark == (frame.lights[0].centre.data[i] == raytrace::PointVisibility::shadowed) &&
                     dark == (drawn.light().visibility.data[i] < 0.5f)
                 ? 0
                 : 1;
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(sheet, 500);
  EXPECT_GT(shadowed, 300);
}

}  // namespace
}  // namespace gnomon::test
