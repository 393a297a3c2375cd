// Which surface each pixel shows and each texel stores, against brute-force rays away from edges.
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

class Ids : public testing::TestWithParam<LightType> {
 protected:
  Drawn make() {
    Scene scene = still_life(GetParam() == LightType::spot);
    scene.lights = {GetParam() == LightType::directional
                        ? sun({-0.5, -1.0, -0.6})
                        : lamp(GetParam(), {0.2, 2.2, 1.2}, {0.0, 0.0, 0.0})};
    return draw(scene, small_options(96));
  }
};

TEST_P(Ids, OfPixelsAreThoseOfTheNearestHit) {
  const Drawn drawn = make();
  const View view = drawn.view();
  int tested = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto hit = hit_away_from_edges(*drawn.world, view, x, y);
      if (!hit) continue;
      ++tested;
      ASSERT_EQ(drawn.frame.primitive.at(x, y), hit->primitive) << x << ", " << y;
    }
  }
  EXPECT_GT(tested, static_cast<int>(view.size.pixels() * 9 / 10));
}

// Rounding leaves less than 1e-4 of these depths, and surfaces that lie on one ray are farther apart.
TEST_P(Ids, TexelsStoreTheHitNearestToTheLight) {
  const Drawn drawn = make();
  const raster::ShadowMap& map = drawn.light().map;
  int tested = 0, empty = 0;
  for (int face = 0; face < map.view.face_count; ++face) {
    for (int row = 0; row < map.view.size; ++row) {
      for (int column = 0; column < map.view.size; ++column) {
        const auto hit = hit_away_from_edges(*drawn.world, map.view, face, column, row);
        if (!hit) continue;
        const std::size_t texel = map.texel_index(face, column, row);
        const Ray ray = texel_ray(map.view, face, column + 0.5, row + 0.5);
        const double depth = depth_of(map.view, face, ray, hit->t);
        const bool stored =
            hit->primitive != no_id && stored_from_depth(map.view, face, row + 0.5, depth) < 1.0;
        ASSERT_EQ(map.depth[texel] == 1.0f, !stored) << face << ": " << column << ", " << row;
        if (stored) {
          ASSERT_NEAR(depth_from_stored(map.view, face, row + 0.5, map.depth[texel]), depth, 1e-4)
              << face << ": " << column << ", " << row;
        }
        ++tested;
        empty += stored ? 0 : 1;
      }
    }
  }
  EXPECT_GT(tested, map.view.face_count * map.view.size * map.view.size * 4 / 5);
  if (GetParam() == LightType::point) {
    EXPECT_GT(empty, 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, Ids,
                         testing::Values(LightType::directional, LightType::point, LightType::spot));

}  // namespace
}  // namespace gnomon::test
