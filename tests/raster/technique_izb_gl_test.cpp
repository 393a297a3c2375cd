// The irregular z-buffer is exact: zero wrong pixels outside `uncertain`, on every built-in scene and on the
// real models. Small pictures and a coarse grid, so that lists are long.
#include <filesystem>

#include "scene/generate/generate.h"
#include "scene/load.h"
#include "tests/support/compare_support.h"
#include "tests/support/model_files.h"
#include "tests/support/one_world.h"
#include "tests/support/raster_scenes.h"
#include "tests/support/solid_samples.h"

namespace gnomon::test {
namespace {

void expect_exact(Scene scene, const std::string& name, ImageSize size, int grid) {
  if (scene.lights.empty()) return;
  OneWorld one(std::move(scene));
  compare::CompareOptions options = test_options(size, grid);
  options.raster.map.technique = raster::Technique::izb;
  for (Light& light : one.scene.lights) light.extent = {};
  const compare::Comparison result = one.compare(options);
  std::uint64_t wrong = 0, compared = 0, shadowed = 0, uncertain = 0;
  for (const compare::LightComparison& light : result.lights) {
    wrong += light.error.wrong, compared += light.pixels.compared, uncertain += light.pixels.uncertain;
    for (std::size_t i = 0; i < light.labels.data.size(); ++i)
      shadowed += compare::is_compared(light.labels.data[i]) && light.rungs[0].data[i] < 0.5f;
  }
  std::printf("  %-44s compared %7llu  in shadow %6llu  uncertain %3llu  wrong %llu\n", name.c_str(),
              static_cast<unsigned long long>(compared), static_cast<unsigned long long>(shadowed),
              static_cast<unsigned long long>(uncertain), static_cast<unsigned long long>(wrong));
  EXPECT_EQ(wrong, 0u) << name;
}

TEST(Izb, IsExactOnAStillLifeWithEveryKindOfLight) {
  for (const bool infinite : {false, true}) {
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot}) {
      Scene scene = still_life(infinite);
      scene.lights = {type == LightType::directional ? sun({0.6, -1.0, 0.35})
                                                     : lamp(type, {0.3, 2.2, 1.0}, {0, 0, 0})};
      expect_exact(std::move(scene), infinite ? "still life on a plane" : "still life", {320, 200}, 64);
    }
  }
}

// Quadrics of every kind, open and closed, a torus and implicit surfaces, which shadow the floor, each other
// and themselves.
TEST(Izb, IsExactOnEverySolid) {
  Scene scene;
  scene.materials.resize(1);
  const std::size_t kinds = solid_samples().size();
  for (std::size_t i = 0; i < kinds; ++i) {
    const std::size_t column = i % 5, row = i / 5;
    const Vec3 at(2.2 * static_cast<double>(column) - 4.4, 0.0, 2.2 * static_cast<double>(row) - 2.2);
    scene.shapes.push_back(solid_samples(1.0, at)[i]);
  }
  scene.shapes.push_back({"floor", Plane{Vec3(0.0, -1.3, 0.0), Vec3(0.0, 1.0, 0.0)}, 0});
  scene.camera.eye = Vec3(1.5, 6.5, 9.0);
  scene.camera.target = Vec3(0.0, -0.6, 0.4);
  scene.lights = {sun({-0.7, -1.0, -0.45}), lamp(LightType::point, {0.6, 4.0, 1.2}, {0, 0, 0})};
  expect_exact(std::move(scene), "every solid", {480, 300}, 128);
}

TEST(Izb, IsExactOnEveryBuiltinScene) {
  for (const auto& entry : builtin_scenes()) {
    if (entry.large) continue;
    auto scene = load_scene(std::string(entry.name));
    ASSERT_TRUE(scene.has_value()) << scene.error().message();
    ImageSize size{160, 90};
    // At that size some rays enter the torus's box on the torus itself.
    if (entry.name == std::string_view("shapes")) size = {1280, 720};
    // All that is small in it is in the lists of two texels, which every pixel there goes through.
    if (entry.name == std::string_view("stadium")) size = {80, 45};
    expect_exact(std::move(*scene), std::string(entry.name), size, 256);
  }
}

TEST(Izb, IsExactOnTheRealModels) {
  if (data_is_absent()) GTEST_SKIP() << "no models in " << data_folder();
  for (const std::string& file : well_formed_models()) {
    auto scene = load_scene(file);
    if (!scene) continue;  // a model without triangles; compare_models_gl_test looks at those
    expect_exact(std::move(*scene), std::filesystem::path(file).filename().string(), {120, 68}, 256);
  }
}

}  // namespace
}  // namespace gnomon::test
