// Receivers classified many at a time in floats: never surer than the sheets in double, and hardly less sure.
#include <gtest/gtest.h>

#include <map>

#include "hybrid/light_sheets.h"
#include "raytrace/tiles.h"
#include "scene/load.h"
#include "tests/hybrid/hybrid_support.h"

namespace gnomon {
namespace {

using hybrid::Certainty;
using raytrace::SurfacePoint;
using test::Stage;

struct Agreement {
  std::uint64_t receivers = 0, contradicted = 0, withheld = 0;
};

bool has(const raytrace::LaneMask& bits, std::size_t lane) {
  return (bits[lane / raytrace::packet_rays] >> (lane % raytrace::packet_rays) & 1) != 0;
}

void compare_receiver(const hybrid::LightSheets& sheets, const Light& light, const SurfacePoint& point,
                      const hybrid::TileClasses& classes, std::size_t lane, Agreement& out) {
  const bool unreached = light_cannot_reach(light, point.position, point.normal);
  const Certainty truth = sheets.at(point.position, point.primitive);
  const int said = has(classes.unreached, lane) + has(classes.lit, lane) + has(classes.shadowed, lane) +
                   has(classes.ambiguous, lane) + has(classes.open, lane);
  EXPECT_EQ(said, 1) << "each receiver is in one class";
  ++out.receivers;
  const bool right = has(classes.unreached, lane)  ? unreached
                     : has(classes.lit, lane)      ? !unreached && truth == Certainty::lit
                     : has(classes.shadowed, lane) ? !unreached && truth == Certainty::shadowed
                                                   : true;
  out.contradicted += right ? 0 : 1;
  const bool withheld = has(classes.open, lane) || has(classes.ambiguous, lane);
  out.withheld += withheld && (unreached || truth != Certainty::ambiguous) ? 1 : 0;
}

Agreement compare(const Stage& stage, std::uint32_t index, int map_size) {
  const Light& light = stage.scene.lights[index];
  hybrid::LightCache cache(stage.tracer, stage.topology, light, stage.map(index, map_size));
  const raytrace::Receivers receivers = raytrace::make_receivers(stage.frame.receiver);
  Image<raytrace::PointVisibility> visibility;
  static_cast<void>(
      trace_hard_shadows(stage.tracer, cache, receivers, visibility, nullptr));  // looks closely
  Agreement out;
  const raytrace::TileGrid grid{stage.size};
  for (std::size_t i = 0; i < grid.count(); ++i) {
    const raytrace::QuantisedTile& tile = receivers.tiles[i];
    if (!tile.any) continue;
    hybrid::TileClasses classes;
    classify_tile(cache.sheets, light, tile, classes);
    for (std::size_t lane = 0; lane < raytrace::tile_rays; ++lane) {
      if (!has(tile.present, lane)) continue;
      const raytrace::TilePixel at = raytrace::tile_pixel(lane);
      const auto x = static_cast<int>(i % grid.columns()) * raytrace::tile_pixels + at.x;
      const auto y = static_cast<int>(i / grid.columns()) * raytrace::tile_pixels + at.y;
      compare_receiver(cache.sheets, light, receivers.points.at(x, y), classes, lane, out);
    }
  }
  return out;
}

// Withheld are receivers whose reciprocal depth lies within the floats' error of a bound, or that stand edge-on to
// the light: a few in a thousand. Around a point light a tile's receivers on another face of the cube than
// its middle are withheld too; tiles are large in so small a picture.
TEST(HybridClassify, FloatsAreNeverSurerThanDoubles) {
  for (const char* name : {"courtyard", "whitted", "fence", "penumbra"}) {
    auto scene = load_scene(name);
    ASSERT_TRUE(scene);
    const Stage stage(std::move(*scene), {320, 180});
    for (std::uint32_t light = 0; light < stage.scene.lights.size(); ++light) {
      if (stage.scene.lights[light].type == LightType::spot) continue;
      for (const int size : {64, 1000, 2048}) {
        const Agreement out = compare(stage, light, size);
        EXPECT_EQ(out.contradicted, 0u) << name << " light " << light << " map " << size;
        const bool cube = stage.scene.lights[light].type == LightType::point;
        if (cube && size > 1000) continue;
        EXPECT_LT(out.withheld, out.receivers / (cube ? 5 : 100))
            << name << " light " << light << " map " << size;
      }
    }
  }
}

TEST(HybridClassify, FarFromTheOriginToo) {
  const Vec3 offset(4096.5, -1023.25, 77.0);
  Mesh soup = test::triangle_soup(200, 1.0, 0.3, 3);
  for (Vec3& p : soup.positions) p += offset;
  Scene scene = test::scene_of({std::move(soup)}, {test::plane(offset + Vec3(0, -1.1, 0), {0, 1, 0})});
  scene.lights = {test::sun(glm::normalize(Vec3(-0.3, -1, -0.2))),
                  test::point_light(offset + Vec3(0.1, 0.2, 0.0))};
  scene.camera.eye = offset + Vec3(1.2, 1.5, 3.0), scene.camera.target = offset;
  const Stage stage(std::move(scene), {160, 90});
  for (std::uint32_t light = 0; light < 2; ++light)
    EXPECT_EQ(compare(stage, light, 300).contradicted, 0u) << light;
}

TEST(TexelParts, FindsWhatWasPutIn) {
  hybrid::TexelParts parts;
  EXPECT_TRUE(parts.empty());
  std::map<std::uint32_t, std::uint32_t> expected;
  test::Random random(7);
  for (int i = 0; i < 5000; ++i) {
    const std::uint32_t key = random.below(65536);
    if (!expected.emplace(key, static_cast<std::uint32_t>(i)).second) continue;
    parts.insert(key, {static_cast<std::uint32_t>(i), 0u});
  }
  for (std::uint32_t key = 0; key < 65536; ++key) {
    const hybrid::PackedBounds* found = parts.find(key);
    const auto it = expected.find(key);
    ASSERT_EQ(found != nullptr, it != expected.end()) << key;
    if (found != nullptr) {
      EXPECT_EQ(found->lit_above_slope_u, it->second);
    }
  }
}

// Bounds only ever move towards ambiguity, by less than 2^-12 of themselves; rounded slopes come back whole.
TEST(PackedBounds, RoundTowardsAmbiguity) {
  test::Random random(11);
  constexpr float inf = hybrid::no_reciprocal_depth;
  const auto any = [&] {
    const float size = std::ldexp(1.0f, static_cast<int>(random.below(60)) - 30);
    return size * static_cast<float>(random.uniform(-1.0, 1.0));
  };
  for (int i = 0; i < 100000; ++i) {
    const hybrid::TexelBounds b{any(), any(), hybrid::round_slope(any()), hybrid::round_slope(any())};
    const hybrid::TexelBounds back = hybrid::unpack(hybrid::pack(b));
    ASSERT_GE(back.lit_above, b.lit_above);
    ASSERT_LE(back.lit_above - b.lit_above, 0x1p-12f * std::abs(b.lit_above));
    ASSERT_LE(back.dark_below, b.dark_below);
    ASSERT_LE(b.dark_below - back.dark_below, 0x1p-12f * std::abs(b.dark_below));
    ASSERT_EQ(back.slope_u, b.slope_u);
    ASSERT_EQ(back.slope_v, b.slope_v);
    const float slope = any();
    ASSERT_LE(std::abs(hybrid::round_slope(slope) - slope), 0.125f * std::abs(slope));
  }
  for (const hybrid::TexelBounds& b : {hybrid::ambiguous_texel, hybrid::empty_texel}) {
    const hybrid::TexelBounds back = hybrid::unpack(hybrid::pack(b));
    EXPECT_EQ(back.lit_above, b.lit_above);
    EXPECT_EQ(back.dark_below, b.dark_below);
  }
  const hybrid::TexelBounds zero = hybrid::unpack(hybrid::pack({0.0f, -0.0f, 0.0f, -0.0f}));

  EXPECT_EQ(zero.lit_above, 0.0f);
  EXPECT_EQ(zero.dark_below, 0.0f);
  EXPECT_GT(hybrid::unpack(hybrid::pack({3.4e38f, 0.0f, 0.0f, 0.0f})).lit_above, 3.3e38f);
  EXPECT_EQ(hybrid::unpack(hybrid::pack({inf, -inf, 0.0f, 0.0f})).lit_above, inf);
}

}  // namespace
}  // namespace gnomon
