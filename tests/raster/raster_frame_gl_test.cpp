// The per-pixel records against scene/light_map/light_view.h in double precision, and against each other.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "scene/base/stages.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

class Records : public testing::TestWithParam<LightType> {
 protected:
  Drawn make(bool infinite_ground = true) {
    Scene scene = still_life(infinite_ground);
    scene.lights = {GetParam() == LightType::directional
                        ? sun({-0.5, -1.0, -0.6})
                        : lamp(GetParam(), {0.2, 2.2, 1.2}, {0.0, 0.0, 0.0})};
    raster::RasterOptions options = small_options(256);
    options.map.bias = {.constant = 0.01, .unit = raster::BiasUnit::world};
    return draw(scene, options);
  }
};

/// How far single precision may move a receiver: positions are floats relative to a point near the scene,
/// good to some 2^-24 of the distances involved, and a pixel ray that grazes the surface slides along it. 16
/// such errors are allowed.
double position_tolerance(const World& world, const LightView& map, const Ray& ray, const ReferenceHit& hit) {
  const Vec3 position = ray.at(hit.t);
  const double facing = std::abs(glm::dot(geometric_normal(world, hit.primitive, position), ray.direction));
  return 16.0 * std::exp2(-24) * (glm::length(position - map.origin) + hit.t / facing);
}

// Texel position, face and distance of the receiver. A texel is half_extent * 2 / size wide at unit depth.
TEST_P(Records, MatchTheReceiversOwnPlaceInTheMap) {
  const Drawn drawn = make();
  const auto& record = drawn.light();
  const LightView& map = record.map.view;
  const View view = drawn.view();
  int tested = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto hit = hit_away_from_edges(*drawn.world, view, x, y);
      if (!hit || hit->primitive == no_id) continue;
      const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      const Vec3 position = ray.at(hit->t);
      const TexelCoordinate at = project_to_texel(map, position);
      const std::size_t pixel = record.gap.index(x, y);
      const double tolerance = position_tolerance(*drawn.world, map, ray, *hit);
      if (record.face.data[pixel] != at.face) {
        const Vec3 d = glm::abs(position - map.origin);
        std::array<double, 3> sorted{d.x, d.y, d.z};
        std::sort(sorted.begin(), sorted.end());
        ASSERT_LE(sorted[2] - sorted[1], tolerance) << "another face away from the cube's edges";
        continue;
      }
      ++tested;
      ASSERT_NEAR(record.distance.data[pixel], at.distance, tolerance);
      if (at.depth <= 0.0) continue;
      const double width = map.projection == LightProjection::perspective ? at.depth : 1.0;
      const Vec2 texels = tolerance / width * 0.5 * map.size / map.face(0).half_extent *
                          (1.0 + std::abs(at.u / map.size - 0.5) + std::abs(at.v / map.size - 0.5));
      ASSERT_NEAR(record.texel_uv.data[pixel].x, at.u, texels.x + 1e-6 * at.u);
      ASSERT_NEAR(record.texel_uv.data[pixel].y, at.v, texels.y + 1e-6 * at.v);
    }
  }
  EXPECT_GT(tested, 15000);
}

// The gap, in world units, from the record's own texel and the stored depth. Bound: the receiver's position
// as above, plus what one unit in the last place of the stored value is worth in depth.
TEST_P(Records, GapIsTheDistanceBehindTheStoredDepth) {
  const Drawn drawn = make();
  const auto& record = drawn.light();
  const LightView& map = record.map.view;
  const View view = drawn.view();
  int tested = 0, empty = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto hit = hit_away_from_edges(*drawn.world, view, x, y);
      if (!hit || hit->primitive == no_id) continue;
      const std::size_t pixel = record.gap.index(x, y);
      const Vec2f uv = record.texel_uv.data[pixel];
      const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      const TexelCoordinate at = project_to_texel(map, ray.at(hit->t));
      const bool behind = map.projection == LightProjection::perspective && at.depth <= 0.0;
      const bool inside = !behind && uv.x >= 0 && uv.y >= 0 && uv.x < map.size && uv.y < map.size;
      const double stored =
          inside ? record.map.depth[record.map.texel_index(record.face.data[pixel], static_cast<int>(uv.x),
                                                           static_cast<int>(uv.y))]
                 : 1.0;
      if (at.face != record.face.data[pixel]) continue;
      if (stored == 1.0) {
        ++empty;
        ASSERT_EQ(record.gap.data[pixel], -std::numeric_limits<float>::infinity());
        ASSERT_EQ(record.visibility.data[pixel], 1.0f);
        ASSERT_EQ(record.outside_map.data[pixel], !inside || at.depth > map.face(at.face).far_depth ||
                                                      at.depth < map.face(at.face).near_depth);
        continue;
      }
      ++tested;
      const double along = map.projection == LightProjection::perspective ? at.distance / at.depth : 1.0;
      const double expected = (at.depth - depth_from_stored(map, at.face, at.v, stored)) * along;
      const double ulp = depth_from_stored(map, at.face, at.v, stored + std::exp2(-24)) -
                         depth_from_stored(map, at.face, at.v, stored);
      const double tolerance = position_tolerance(*drawn.world, map, ray, *hit) + 2.0 * ulp * along;
      ASSERT_NEAR(record.gap.data[pixel], expected, tolerance) << x << ", " << y;
    }
  }
  EXPECT_GT(tested, 3000);
  if (GetParam() != LightType::point) {
    EXPECT_GT(empty, 10);
  }
}

TEST_P(Records, VisibilityIsTheGapAgainstTheConstantBias) {
  const Drawn drawn = make();
  const auto& record = drawn.light();
  const auto bias = static_cast<float>(record.bias_constant_world);
  EXPECT_EQ(bias, 0.01f);
  int shadowed = 0;
  for (std::size_t i = 0; i < record.gap.data.size(); ++i) {
    if (drawn.frame.primitive.data[i] == no_id) {
      ASSERT_EQ(record.visibility.data[i], 1.0f);
      ASSERT_EQ(record.gap.data[i], 0.0f);
      continue;
    }
    ASSERT_EQ(record.visibility.data[i] == 0.0f, record.gap.data[i] > bias);
    shadowed += record.visibility.data[i] == 0.0f ? 1 : 0;
  }
  EXPECT_GT(shadowed, 300);
}

TEST_P(Records, AreTheSameBitForBitOnASecondRender) {
  Drawn drawn = make();
  const raster::RasterFrame first = drawn.frame;
  drawn.render(first.options);
  const auto& a = first.lights[0];
  const auto& b = drawn.light();
  EXPECT_EQ(drawn.frame.color.data, first.color.data);
  EXPECT_EQ(drawn.frame.primitive.data, first.primitive.data);
  EXPECT_EQ(a.map.depth, b.map.depth);
  EXPECT_EQ(a.gap.data, b.gap.data);
  EXPECT_EQ(a.texel_uv.data, b.texel_uv.data);
  EXPECT_EQ(a.distance.data, b.distance.data);
  EXPECT_EQ(a.visibility.data, b.visibility.data);
}

// A map is kept from frame to frame where nothing of it changes, and so is what the camera sees. Bias, size and camera are
// not the map's, but the camera moves the point that its depths are rounded from.
TEST_P(Records, AreThoseOfAFirstFrameWhateverWasDrawnBefore) {
  Drawn drawn = make(false);  // an infinite ground's map would move with the camera
  raster::RasterOptions options = drawn.frame.options;
  options.map.bias.constant *= 3.0;
  options.size = {96, 64};
  for (const bool moved : {false, true}) {
    if (moved) drawn.scene->camera.eye += Vec3(0.37, -0.21, 0.11);
    drawn.render(options);
    const Drawn fresh = draw(*drawn.scene, options);
    EXPECT_EQ(drawn.light().map.depth, fresh.light().map.depth) << moved;
    EXPECT_EQ(drawn.light().gap.data, fresh.light().gap.data) << moved;
    EXPECT_EQ(drawn.light().visibility.data, fresh.light().visibility.data) << moved;
    EXPECT_EQ(drawn.frame.color.data, fresh.frame.color.data) << moved;
    raster::RasterOptions picture = options;
    picture.analysis = false;
    drawn.render(picture);
    EXPECT_EQ(drawn.frame.color.data, draw(*drawn.scene, picture).frame.color.data) << moved;
  }
  drawn.scene->lights[0].position.y += 0.05, drawn.scene->lights[0].direction.x += 0.05;
  options.analysis = false;
  drawn.render(options);
  EXPECT_EQ(drawn.frame.color.data, draw(*drawn.scene, options).frame.color.data);
  drawn.scene->camera.eye.x -= 0.25, drawn.scene->camera.target.x -= 0.25;
  drawn.render(options);
  EXPECT_EQ(drawn.frame.color.data, draw(*drawn.scene, options).frame.color.data);
}

// How depths are looked up is no part of the map: a filter takes the map that a hard test left, with its times, and a second
// frame of cascades the first one's, where its depths are not handed on.
TEST_P(Records, AMapServesEveryTechniqueThatDrawsIt) {
  using raster::Technique;
  Drawn drawn = make(false);
  raster::RasterOptions options = drawn.frame.options;
  options.runs = 1;
  options.map_contents = false;
  const StageLog log;
  const auto ms_of_runs = [&] {
    const TimeBudget budget = log.budget();
    const StageTime* stage = budget.find("map runs");
    return stage == nullptr ? 0.0 : stage->wall_ms;
  };
  const auto draw_with = [&](Technique technique, bool anew) {
    options.map.technique = technique;
    options.map.bias.constant *= 2.0;
    const double before = ms_of_runs();
    drawn.render(options);
    EXPECT_EQ(ms_of_runs() > before, anew) << raster::technique_name(technique);
    EXPECT_EQ(drawn.light().map_pass.runs.size(), 1U);
    const Drawn fresh = draw(*drawn.scene, options);
    EXPECT_EQ(drawn.light().visibility.data, fresh.light().visibility.data)
        << raster::technique_name(technique);
  };
  draw_with(Technique::hard, true);
  draw_with(Technique::pcf, false);
  draw_with(Technique::pcss, false);
  draw_with(Technique::vsm, true);
  draw_with(Technique::hard, false);  // its map lies beside
  draw_with(Technique::vsm, true);    // what it made of its map does not
  if (GetParam() != LightType::directional) return;
  draw_with(Technique::csm, true);
  draw_with(Technique::csm, false);
}

TEST_P(Records, TimesHoldEveryRunAndChangeNothing) {
  Drawn drawn = make();
  const auto color = drawn.frame.color.data;
  EXPECT_TRUE(drawn.light().map_pass.runs.empty());
  raster::RasterOptions options = drawn.frame.options;
  options.runs = 2;
  drawn.render(options);
  EXPECT_EQ(drawn.light().map_pass.runs.size(), 2u);
  EXPECT_EQ(drawn.light().shade_pass.runs.size(), 2u);
  EXPECT_GT(drawn.light().shade_pass.median(), 0.0);
  EXPECT_EQ(drawn.frame.color.data, color);
}

// It is drawn no second time, where all but records and time are the same.
TEST_P(Records, APicturesKeptTimeIsTheRunOfTheNextFrame) {
  Drawn drawn = make(false);
  raster::RasterOptions timed = drawn.frame.options, picture = timed;
  timed.runs = 1;
  picture.analysis = false, picture.keep_time = true;
  drawn.render(timed);  // with the camera's runs, which stay
  const StageLog log;
  double before_ms = 0.0;
  const auto made_runs = [&] {
    const TimeBudget budget = log.budget();
    const StageTime* stage = budget.find("shading runs");
    const double ms = stage != nullptr ? stage->wall_ms : 0.0;
    return std::exchange(before_ms, ms) < ms;
  };
  const auto color = drawn.frame.color.data;
  drawn.render(picture);
  EXPECT_EQ(drawn.frame.color.data, color);
  drawn.render(timed);
  EXPECT_FALSE(made_runs());
  EXPECT_EQ(drawn.light().shade_pass.runs.size(), 1u);
  EXPECT_GT(drawn.light().shade_pass.median(), 0.0);
  EXPECT_EQ(drawn.frame.color.data, color);
  drawn.render(timed);
  EXPECT_TRUE(made_runs()) << "it counts once";
  drawn.render(picture);
  timed.map.bias.constant *= 2.0;
  drawn.render(timed);
  EXPECT_TRUE(made_runs()) << "of another bias";
}

// Between a picture and the next records, whose map stays the kept one.
TEST_P(Records, SpansOfDrawingAreTimedAndChangeNothing) {
  Drawn drawn = make(false);
  const Drawn fresh = make(false);
  const raster::RasterOptions records = drawn.frame.options;
  raster::RasterOptions picture = records;
  picture.runs = 0, picture.analysis = false, picture.span_drawings = 3;
  EXPECT_FALSE(drawn.renderer->take_spans()->counted) << "none were asked for";
  drawn.render(picture);
  EXPECT_EQ(drawn.frame.color.data, fresh.frame.color.data);
  std::optional<raster::ShadowSpans> spans;
  while (!spans) spans = drawn.renderer->take_spans();
  EXPECT_TRUE(spans->counted);
  EXPECT_GT(spans->map_ms, 0.0);
  EXPECT_GT(spans->shaded_ms, 0.0);
  EXPECT_GT(spans->unshadowed_ms, 0.0);
  EXPECT_FALSE(drawn.renderer->take_spans()->counted) << "once";
  drawn.render(records);
  EXPECT_EQ(drawn.frame.color.data, fresh.frame.color.data);
  EXPECT_EQ(drawn.light().map.depth, fresh.light().map.depth);
  EXPECT_EQ(drawn.light().visibility.data, fresh.light().visibility.data);
}

void expect_same_frame(const Drawn& drawn, const Drawn& fresh, const std::string& what) {
  EXPECT_EQ(drawn.frame.color.data, fresh.frame.color.data) << what;
  EXPECT_EQ(drawn.frame.primitive.data, fresh.frame.primitive.data) << what;
  for (std::size_t i = 0; i < fresh.frame.lights.size(); ++i) {
    EXPECT_EQ(drawn.light(i).map.depth, fresh.light(i).map.depth) << what;
    EXPECT_EQ(drawn.light(i).gap.data, fresh.light(i).gap.data) << what;
    EXPECT_EQ(drawn.light(i).visibility.data, fresh.light(i).visibility.data) << what;
  }
}

// What the camera sees is drawn by the first timed frames of a view alone, and the runs of the later ones are warmed up
// without it. A map may be kept from a frame that did not hand it on, but not for one that does.
TEST_P(Records, TimedFramesAreThoseOfAFirstFrameWhateverWasDrawnBefore) {
  using raster::Technique;
  Drawn drawn = make(false);
  raster::RasterOptions options = drawn.frame.options;
  for (const bool moved : {false, true}) {
    if (moved) drawn.scene->camera.eye += Vec3(0.37, -0.21, 0.11);
    std::map<std::pair<Technique, bool>, Drawn> first_frames;
    for (int frame = 0; frame < 5; ++frame)
      for (const auto technique : {Technique::hard, Technique::pcf, Technique::vsm, Technique::izb})
        for (const bool contents : {false, true}) {
          options.map.technique = technique;
          options.map_contents = contents;
          options.map.size = technique == Technique::izb ? 64 : 256;
          options.runs = 1 + frame % 2;
          options.shadow_cost = frame == 4;
          drawn.render(options);
          EXPECT_EQ(drawn.light().shade_pass.runs.size(), static_cast<std::size_t>(options.runs));
          if (frame < 3) continue;
          auto first = first_frames.find({technique, contents});
          if (first == first_frames.end()) {
            raster::RasterOptions untimed = options;
            untimed.runs = 0, untimed.shadow_cost = false;
            first = first_frames.emplace(std::pair(technique, contents), draw(*drawn.scene, untimed)).first;
          }
          expect_same_frame(drawn, first->second,
                            fmt::format("{} {} {} {}", moved, frame, static_cast<int>(technique), contents));
        }
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, Records,
                         testing::Values(LightType::directional, LightType::point, LightType::spot));

}  // namespace
}  // namespace gnomon::test
