// Lights with size: samples in penumbrae alone, and every pixel as full sampling has it.
#include <gtest/gtest.h>

#include "hybrid/soft_shadows.h"
#include "scene/load.h"
#include "tests/hybrid/hybrid_support.h"

namespace gnomon {
namespace {

using hybrid::Decision;
using hybrid::LightCache;
using hybrid::SoftCounts;
using hybrid::SoftLight;
using raytrace::PointVisibility;
using test::Stage;

struct SoftOutcome {
  SoftCounts soft;
  std::uint64_t asked = 0, different = 0, partly = 0;  ///< partly: of the truth, neither 0 nor 1
};

SoftOutcome run_soft(const Stage& stage, std::uint32_t light) {
  const Light& source = stage.scene.lights[light];
  LightCache cache(stage.tracer, stage.topology, source, stage.map(light, 512));
  Image<PointVisibility> centre;
  Image<Decision> decisions(stage.size);
  Image<float> visibility(stage.size);
  SoftOutcome out;
  out.asked = trace_hard_shadows(stage.tracer, cache, raytrace::make_receivers(stage.frame.receiver), centre,
                                 &decisions)
                  .asked;
  out.soft = SoftLight(stage.tracer, stage.topology, light)
                 .find(stage.frame.receiver, centre, {source.shadow_samples, 5, 0}, decisions, visibility);
  const auto& truth = stage.frame.lights[light].visibility.data;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool differs = truth[i] != visibility.data[i];
    if (differs && out.different == 0)
      ADD_FAILURE() << stage.scene.name << " light " << light << " pixel "
                    << i % static_cast<std::size_t>(stage.size.width) << ","
                    << i / static_cast<std::size_t>(stage.size.width) << ": " << visibility.data[i]
                    << " instead of " << truth[i] << ", decision " << static_cast<int>(decisions.data[i]);
    out.different += differs ? 1 : 0;
    out.partly += truth[i] > 0.0f && truth[i] < 1.0f ? 1 : 0;
  }
  std::cout << stage.scene.name << " light " << light << ": " << out.soft.penumbra << " of " << out.asked
            << " sampled, " << out.partly << " partly lit\n";
  return out;
}

TEST(HybridSoftShadows, DiscOverTheBunny) {
  const auto stage = test::model_stage("/common_organic/stanford-bunny.obj", {320, 180}, true);
  if (!stage) GTEST_SKIP() << "no bunny";
  const SoftOutcome out = run_soft(*stage, 0);
  EXPECT_EQ(out.different, 0u);
  EXPECT_GT(out.partly, 0u);
  // Measured: 21 % of the receivers; most of the others would be wasted samples.
  EXPECT_LT(static_cast<double>(out.soft.penumbra), 0.3 * static_cast<double>(out.asked));
}

TEST(HybridSoftShadows, EveryKindOfLight) {
  for (const char* name : {"penumbra", "sphere-plane", "teapot", "floating-box"}) {
    auto scene = load_scene(name);
    ASSERT_TRUE(scene);
    const Light first = scene->lights[0];
    const bool sun = first.type == LightType::directional;
    scene->lights.clear();
    const double size = 0.05 * glm::length(scene->camera.eye - scene->camera.target);
    std::vector<LightExtent> extents{SunDisc{0.03}};
    if (!sun)
      extents = {SphereLight{size}, DiscLight{size, glm::normalize(Vec3(0.2, -1.0, 0.1))},
                 RectangleLight{Vec3(2.0 * size, 0, 0), Vec3(0, 0, size)}};
    for (const LightExtent& extent : extents) {
      scene->lights.push_back(first);
      scene->lights.back().extent = extent, scene->lights.back().shadow_samples = 16;
    }
    const Stage stage(std::move(*scene), {192, 108}, true);
    for (std::uint32_t light = 0; light < stage.scene.lights.size(); ++light)
      EXPECT_EQ(run_soft(stage, light).different, 0u);
  }
}

}  // namespace
}  // namespace gnomon
