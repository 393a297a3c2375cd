// Alpha masks in packets: where MaskCells are sure, lookups agree; where packets are sure, the double kernels are.
#include <gtest/gtest.h>

#include "raytrace/shapes/mask_cells.h"
#include "scene/texture_sample.h"
#include "tests/support/packet_checks.h"

namespace gnomon {
namespace {

using raytrace::Accel;
using raytrace::MaskCells;
using raytrace::MaskKind;
using raytrace::Tracer;
using test::check;
using test::lights_around;
using test::look;
using test::Random;
using test::TestWorld;

/// Blobs of about `blob` texels, with smooth edges.
Texture blobs(ImageSize size, double blob, Random& random) {
  Texture texture;
  texture.size = size;
  const double phase = random.uniform(0.0, 6.0);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const double wave = std::sin(3.0 * x / blob + phase) + std::sin(3.0 * y / blob + 2.0 * phase);
      const double alpha = std::clamp(128.0 + 150.0 * wave, 0.0, 255.0);
      texture.texels.emplace_back(200, 150, 100, static_cast<std::uint8_t>(alpha));
    }
  return texture;
}

Material masked(std::uint32_t texture) {
  Material material;
  material.alpha_mode = AlphaMode::mask, material.diffuse_texture = texture;
  return material;
}

TEST(MaskCells, HoldForLookupsUpToATexelAround) {
  Random random(1);
  std::size_t sure = 0, asked = 0;
  for (int round = 0; round < 60; ++round) {
    Scene scene;
    const ImageSize size{1 + static_cast<int>(random.below(70)), 1 + static_cast<int>(random.below(40))};
    Texture texture = blobs(size, random.uniform(2.0, 30.0), random);
    texture.nearest = random.below(3) == 0;
    texture.repeat_s = random.below(2) == 0, texture.repeat_t = random.below(2) == 0;
    scene.textures = {texture};
    Material material = masked(0);
    material.alpha = static_cast<float>(random.uniform(0.4, 1.0));
    material.alpha_cutoff = static_cast<float>(random.uniform(-0.1, 1.1));
    const MaskCells cells(scene, material);
    ASSERT_EQ(cells.size().width, size.width);
    for (int i = 0; i < 2000; ++i) {
      const Vec2 place{random.uniform(-1.5 * size.width, 2.5 * size.width),
                       random.uniform(-1.5 * size.height, 2.5 * size.height)};
      const MaskKind kind =
          cells.at(static_cast<int>(std::floor(place.x)), static_cast<int>(std::floor(place.y)));
      const Vec2 near = place + Vec2{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
      const Vec2 uv = (near + 0.5) / Vec2(size.width, size.height);
      const bool hole = material.alpha * sample_texture(texture, uv).a < material.alpha_cutoff;
      ASSERT_FALSE(kind == MaskKind::opaque && hole) << "texel " << near.x << ' ' << near.y;
      ASSERT_FALSE(kind == MaskKind::hole && !hole) << "texel " << near.x << ' ' << near.y;
      sure += kind != MaskKind::mixed ? 1 : 0, ++asked;
    }
  }
  EXPECT_GT(sure, asked / 3);
}

// An alpha that is the cutoff is no hole, but a mean of such is rounded: nobody is sure of it.
TEST(MaskCells, AlphasAtTheCutoffAreMixed) {
  Scene scene;
  Texture texture;
  texture.size = {4, 4}, texture.texels.assign(16, {255, 255, 255, 51});
  scene.textures = {texture};
  Material material = masked(0);
  material.alpha_cutoff = 51.0f / 255.0f;
  EXPECT_EQ(MaskCells(scene, material).at(1, 1), MaskKind::mixed);
  material.alpha_cutoff = 0.3f;
  EXPECT_EQ(MaskCells(scene, material).at(1, 1), MaskKind::hole);
  material.alpha_cutoff = 0.0f;
  EXPECT_EQ(MaskCells(scene, material).at(1, 1), MaskKind::opaque);
  material.diffuse_texture = no_id, material.alpha = 0.4f, material.alpha_cutoff = 0.5f;
  EXPECT_EQ(MaskCells(scene, material).at(-7, 9), MaskKind::hole);
}

/// A soup of triangles with masks of every kind, some of them with colours, some without mask or texture.
Scene masked_soup(int count, double size, double uv_scale, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh = test::triangle_soup(count, 1.0, size, seed);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.uvs.emplace_back(uv_scale * Vec2{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)});
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.colors.emplace_back(1.0f, 1.0f, 1.0f, i / 3 % 7 == 0 ? random.uniform(0.3, 1.0) : 1.0);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.triangle_materials.push_back(i % 6);
  Scene scene = test::scene_of({mesh});
  scene.textures = {blobs({256, 128}, 20.0, random), blobs({31, 17}, 8.0, random),
                    blobs({512, 512}, 90.0, random)};
  scene.textures[1].nearest = true, scene.textures[1].repeat_s = false;
  scene.textures[2].repeat_t = false;
  scene.materials.resize(6);
  for (std::uint32_t i = 0; i < 3; ++i) scene.materials[i] = masked(i);
  scene.materials[2].texture_transform = {.offset = {0.3, -0.2}, .scale = {0.7, 1.9}, .rotation = 0.8};
  scene.materials[3] = masked(no_id), scene.materials[3].alpha = 0.4f;
  scene.materials[4] = masked(0), scene.materials[4].double_sided = false;
  look(scene, {0.3, 0.4, 3.0}, {0, 0, 0});
  scene.lights = lights_around(Vec3(0.0), 2.0);
  return scene;
}

TEST(PacketMasks, RandomTriangles) {
  for (const double size : {0.03, 0.2, 1.5})
    for (const double uv_scale : {0.02, 0.5, 30.0})
      check(masked_soup(size < 0.1 ? 6000 : 1500, size, uv_scale, 3), {101, 67});
}

TEST(PacketMasks, FromWithinAndFarFromTheOrigin) {
  Scene within = masked_soup(1500, 0.5, 0.5, 4);
  look(within, {0.01, 0.02, -0.03}, {1, 0.2, 0.1}, 2.0);
  check(within, {101, 67});
  Scene far = masked_soup(1500, 0.2, 0.5, 5);
  const Vec3 offset(1e5, -2e5, 3e5);
  for (Vec3& position : far.meshes[0].positions) position += offset;
  look(far, offset + Vec3(0.3, 0.4, 3.0), offset);
  far.lights = lights_around(offset, 2.0);
  check(far, {101, 67});
}

// Masks so fine that floats do not find the texel.
TEST(PacketMasks, TexelsThatFloatsCannotTellApart) {
  for (const double uv_scale : {1e3, 1e4, 1e5, 1e7}) check(masked_soup(300, 1.5, uv_scale, 7), {101, 67});
}

// Where only the picture is wanted its receivers are found again instead of stored: on masked triangles, too.
TEST(PacketMasks, ThePictureAloneIsThatOfTheFrame) {
  Scene scene = masked_soup(1500, 0.3, 0.1, 8);
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const std::array<std::uint32_t, 2> lights{0, 1};
  raytrace::RaytraceOptions options;
  options.size = {203, 131};
  const auto whole = trace_frame(tracer, plan_effects(scene), scene.camera, lights, options);
  options.records = false;
  const auto alone = trace_frame(tracer, plan_effects(scene), scene.camera, lights, options);
  EXPECT_EQ(alone.color.data, whole.color.data);
  EXPECT_TRUE(alone.receiver.data.empty());
}

// Leaves whose masks have many texels a pixel, in front of one another: few rays are left to the double kernels.
TEST(PacketMasks, FewRaysAreLeft) {
  constexpr ImageSize size{320, 200};
  Random random(6);
  Scene scene = masked_soup(1500, 0.4, 0.5, 6);
  scene.meshes[0].colors.clear(), scene.meshes[0].triangle_materials.clear();
  scene.textures = {blobs({512, 512}, 90.0, random)};
  scene.materials = {masked(0)};
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const View view = make_view(scene.camera, size);
  const raytrace::TileGrid grid{size};
  std::vector<raytrace::TileHits> hits(grid.count());
  primary_pass(tracer, view, edge_setup_of_eye(tracer, view),
               {.size = size, .hits = hits, .receivers = nullptr, .quantised = {}});
  std::size_t open = 0;
  for (const raytrace::TileHits& tile : hits)
    open += static_cast<std::size_t>(std::count(tile.leaf, std::end(tile.leaf), raytrace::ambiguous_hit));
  const std::size_t outside =
      grid.count() * raytrace::tile_rays - static_cast<std::size_t>(size.width * size.height);
  EXPECT_LT(open - outside, static_cast<std::size_t>(size.width * size.height / 5));
}

}  // namespace
}  // namespace gnomon
