// Alpha masks make holes in the camera's image and in the light's map alike; textures look like
// scene/texture_sample.h.
#include <cmath>

#include "scene/texture_sample.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

Texture holes() {
  Texture texture;
  texture.name = "holes";
  texture.size = {4, 4};
  for (int i = 0; i < 16; ++i) {
    const bool hole = (i + i / 4) % 2 == 0;
    texture.texels.emplace_back(40 * (i % 4), 255 - 12 * i, 90, hole ? 0 : 255);
  }
  texture.nearest = true;
  return texture;
}

/// A masked square (or plane) above an opaque ground.
Scene masked_scene(bool as_plane) {
  Scene scene;
  scene.materials.resize(2);
  scene.textures = {holes()};
  scene.materials[1].alpha_mode = AlphaMode::mask;
  scene.materials[1].alpha_cutoff = 1.0f;  // exactly what the opaque texels have: not less, so no hole
  scene.materials[1].diffuse_texture = 0;
  scene.materials[1].texture_transform = {.offset = {0.1, 0.2}, .scale = {1.5, 0.75}, .rotation = 0.4};
  scene.meshes = {square_mesh(4.0), square_mesh(1.5)};
  scene.instances.push_back({"ground", 0, placed(Vec3(0.0), 1.0), 0});
  if (as_plane) {
    scene.shapes.push_back({"screen", Plane{Vec3(0.0, 1.0, 0.0), Vec3(0.0, 1.0, 0.0)}, 1});
  } else {
    scene.instances.push_back({"screen", 1, placed(Vec3(0.0, 1.0, 0.0), 1.0), 1});
  }
  scene.camera.eye = Vec3(1.5, 4.5, 4.0);
  scene.lights = {sun({-0.2, -1.0, -0.1})};
  return scene;
}

/// Texture coordinates of the screen at a point of it.
Vec2 screen_uv(const Vec3& p, bool as_plane) {
  if (!as_plane) return {(p.x + 1.5) / 3.0, (p.z + 1.5) / 3.0};
  Vec3 t, b;
  orthonormal_basis(Vec3(0.0, 1.0, 0.0), t, b);
  const Vec3 d = p - Vec3(0.0, 1.0, 0.0);
  return {glm::dot(t, d), glm::dot(b, d)};
}

class AlphaMask : public testing::TestWithParam<bool> {
 protected:
  /// Distance of a texture coordinate from a texel's border, in texels.
  static double from_border(const Vec2& uv) {
    const auto part = [](double x) { return std::abs(4.0 * x - std::round(4.0 * x)); };
    return std::min(part(uv.x), part(uv.y));
  }
  /// Whether the ray meets an opaque part of the screen; `sure` is false near a hole's border.
  static bool meets_screen(const Scene& scene, const Ray& ray, bool as_plane, bool& sure) {
    const double t = (1.0 - ray.origin.y) / ray.direction.y;
    const Vec3 p = ray.at(t);
    const Material& material = scene.materials[1];
    const Vec2 uv = transform_uv(material.texture_transform, screen_uv(p, as_plane));
    sure = from_border(uv) > 0.06;
    if (!as_plane) {
      const double out = std::max(std::abs(p.x), std::abs(p.z)) - 1.5;
      sure = sure && std::abs(out) > 0.05;
      if (out > 0.0) return false;
    }
    return t > ray.t.min && sample_texture(scene.textures[0], uv).a >= material.alpha_cutoff;
  }
};

TEST_P(AlphaMask, HasHolesInTheCamerasImage) {
  const bool as_plane = GetParam();
  const Drawn drawn = draw(masked_scene(as_plane));
  const View view = drawn.view();
  int opaque = 0, holes_seen = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      bool sure = true;
      const bool screen = meets_screen(*drawn.scene, pixel_ray(view, x + 0.5, y + 0.5), as_plane, sure);
      const std::uint32_t primitive = drawn.frame.primitive.at(x, y);
      if (!sure || primitive == no_id) continue;
      const bool drawn_screen = primitive >= 2;
      ASSERT_EQ(drawn_screen, screen) << x << ", " << y;
      (screen ? opaque : holes_seen) += 1;
    }
  }
  EXPECT_GT(opaque, 1000);
  EXPECT_GT(holes_seen, 1000);
}

TEST_P(AlphaMask, HasHolesInTheLightsMap) {
  const bool as_plane = GetParam();
  const Drawn drawn = draw(masked_scene(as_plane));
  const raster::ShadowMap& map = drawn.light().map;
  int opaque = 0, holes_seen = 0;
  for (int row = 0; row < map.view.size; ++row) {
    for (int column = 0; column < map.view.size; ++column) {
      bool sure = true;
      const Ray ray = texel_ray(map.view, 0, column + 0.5, row + 0.5);
      const bool screen = meets_screen(*drawn.scene, ray, as_plane, sure);
      const double stored = map.depth[map.texel_index(0, column, row)];
      if (!sure || !holds_caster(map.view, stored)) continue;
      const double height = ray.at(depth_from_stored(map.view, 0, row + 0.5, stored)).y;
      ASSERT_EQ(height > 0.5, screen) << column << ", " << row;  // the screen lies at 1, the ground at 0
      (screen ? opaque : holes_seen) += 1;
    }
  }
  EXPECT_GT(opaque, 1000);
  EXPECT_GT(holes_seen, 1000);
}

INSTANTIATE_TEST_SUITE_P(TrianglesAndPlane, AlphaMask, testing::Bool());

// Through a hole in a ball one sees its inside: the receiver is the far crossing.
TEST(AlphaMaskedSphere, ShowsItsInsideThroughItsHoles) {
  Scene scene;
  scene.materials.resize(1);
  scene.textures = {holes()};
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].diffuse_texture = 0;
  scene.shapes.push_back({"ball", Sphere{Vec3(0.2, 0.1, -0.3), 1.0}, 0});
  scene.camera.eye = Vec3(0.5, 0.6, 3.0);
  scene.lights = {sun({-0.2, -1.0, -0.1})};
  const Drawn drawn = draw(scene);
  const View view = drawn.view();
  const auto& ball = std::get<Sphere>(drawn.scene->shapes[0].geometry);
  const auto opaque_at = [&](const Vec3& p, bool& sure) {
    const Vec3 n = glm::normalize(p - ball.center);
    const double turn = std::atan2(n.z, n.x) / (2.0 * pi);
    const Vec2 uv(turn - std::floor(turn), std::acos(n.y) / pi);
    for (const double x : {4.0 * uv.x, 4.0 * uv.y}) sure = sure && std::abs(x - std::round(x)) > 0.01;
    return sample_texture(drawn.scene->textures[0], uv).a > 0.5f;
  };
  int fronts = 0, backs = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      const double near = hit_shape(ray, drawn.scene->shapes[0]);
      if (!(near < infinity)) continue;
      ray.t.min = near + 1e-3;
      const double far = hit_shape(ray, drawn.scene->shapes[0]);
      bool sure = far - near > 0.1;
      const bool front = opaque_at(ray.at(near), sure);
      const bool back = opaque_at(ray.at(far), sure);
      if (!sure) continue;
      const std::size_t pixel = drawn.frame.primitive.index(x, y);
      ASSERT_EQ(drawn.frame.primitive.data[pixel], front || back ? 0u : no_id) << x << ", " << y;
      if (!front && !back) continue;
      const TexelCoordinate at = project_to_texel(drawn.light().map.view, ray.at(front ? near : far));
      ASSERT_NEAR(drawn.light().distance.data[pixel], at.distance, 1e-5);
      (front ? fronts : backs) += 1;
    }
  }
  EXPECT_GT(fronts, 500);
  EXPECT_GT(backs, 300);
}

// Bilinear and nearest, repeated and clamped, sRGB and linear; 8-bit values through float weights.
TEST(Textures, LookLikeTheSharedFormula) {
  for (int kind = 0; kind < 8; ++kind) {
    Scene scene = masked_scene(false);
    scene.instances.pop_back();
    scene.lights.clear();
    scene.ambient = Vec3f(1.0f);
    scene.materials[0].diffuse = Vec3f(1.0f);
    scene.materials[0].diffuse_texture = 0;
    scene.materials[0].texture_transform = {.offset = {-0.7, 0.3}, .scale = {3.0, 2.0}, .rotation = -0.3};
    Texture& texture = scene.textures[0];
    texture.nearest = (kind & 1) != 0;
    texture.srgb = (kind & 2) != 0;
    texture.repeat_s = (kind & 4) != 0;
    texture.repeat_t = (kind & 4) == 0;
    const Drawn drawn = draw(scene);
    const View view = drawn.view();
    int tested = 0;
    for (int y = 0; y < view.size.height; ++y) {
      for (int x = 0; x < view.size.width; ++x) {
        if (drawn.frame.primitive.at(x, y) == no_id) continue;
        const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
        const Vec3 p = ray.at(-ray.origin.y / ray.direction.y);
        const Vec2 uv =
            transform_uv(drawn.scene->materials[0].texture_transform, {(p.x + 4.0) / 8.0, (p.z + 4.0) / 8.0});
        const auto part = [](double t) { return std::abs(4.0 * t - std::round(4.0 * t)); };
        if (texture.nearest && std::min(part(uv.x), part(uv.y)) < 1e-4) continue;
        const Vec3f expected(sample_texture(drawn.scene->textures[0], uv));
        const Vec3f error = glm::abs(drawn.frame.color.at(x, y) - expected);
        ASSERT_LT(std::max({error.x, error.y, error.z}), 2e-4f) << kind << ": " << x << ", " << y;
        ++tested;
      }
    }
    EXPECT_GT(tested, 10000);
  }
}

}  // namespace
}  // namespace gnomon::test
