// What the driver makes of a program when it first draws with it belongs to no timed run. llvmpipe makes an LLVM module for
// each: this program counts them, by the stage of the time budget that runs then. It exports LLVM's function for
// that, and hands each call on to LLVM.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <link.h>

#include <cstring>
#include <map>
#include <string>

#include "hybrid/visibility.h"
#include "raster/renderer.h"
#include "scene/base/stages.h"
#include "tests/support/small_scenes.h"

namespace {

const gnomon::StageLog* running_log = nullptr;
std::map<std::string, int> modules;  // by stage

int find_llvm(dl_phdr_info* info, std::size_t, void* path) {
  if (std::strstr(info->dlpi_name, "libLLVM") == nullptr) return 0;
  *static_cast<std::string*>(path) = info->dlpi_name;
  return 1;
}

void* function_of_llvm(const char* name) {
  std::string path;
  dl_iterate_phdr(find_llvm, &path);
  void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_NOLOAD);
  return library != nullptr ? dlsym(library, name) : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void* LLVMModuleCreateWithNameInContext(const char* name,
                                                                                          void* context) {
  using Create = void* (*)(const char*, void*);
  static const auto create = reinterpret_cast<Create>(function_of_llvm("LLVMModuleCreateWithNameInContext"));
  if (running_log != nullptr) ++modules[std::string(running_log->running())];
  return create(name, context);
}

namespace gnomon::test {
namespace {

/// Opaque and masked triangles, a shape, and lights of all types.
Scene scene_of_everything() {
  Scene scene = boxes_under_three_lights();
  Material screen = scene.materials[0];
  Texture holes;
  holes.size = {2, 2};
  for (const int alpha : {255, 0, 0, 255}) holes.texels.emplace_back(90, 90, 90, alpha);
  scene.textures.push_back(holes);
  screen.alpha_mode = AlphaMode::mask;
  screen.diffuse_texture = 0;
  scene.materials.push_back(screen);
  auto masked = scene.instances.back();
  masked.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  scene.instances.push_back(masked);
  scene.shapes.push_back({"ball", Sphere{Vec3(0.0, 1.0, 0.0), 0.5}, 0});
  return scene;
}

struct Drawer {
  explicit Drawer(Scene given) : scene(std::move(given)), world(make_world(scene)) {
    auto context = raster::create_context(raster::Backend::automatic);
    if (!context) throw std::runtime_error(context.error().message());
    auto made = raster::Renderer::create(std::move(*context), world, plan_effects(scene));
    if (!made) throw std::runtime_error(made.error().message());
    renderer = std::move(*made);
    renderer->use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(world));
  }
  void draw(const raster::RasterOptions& options, const std::vector<std::uint32_t>& lights) {
    const auto frame = renderer->render(options, lights);
    ASSERT_TRUE(frame) << frame.error().message();
  }
  Scene scene;
  World world;
  std::unique_ptr<raster::Renderer> renderer;
};

raster::RasterOptions timed(raster::Technique technique) {
  raster::RasterOptions options;
  options.size = {96, 64};
  options.map.technique = technique;
  options.map.size = 128;
  options.map.bias = raster::default_bias(options.map);
  options.shadow_cost = true;
  return options;
}

std::string found() {
  std::string text;
  for (const auto& [stage, count] : modules) text += stage + " " + std::to_string(count) + ", ";
  return text;
}

class DriverTranslation : public testing::TestWithParam<raster::Technique> {
 protected:
  StageLog log_;
  void SetUp() override { running_log = &log_, modules.clear(); }
  void TearDown() override { running_log = nullptr; }
};

TEST_P(DriverTranslation, IsDoneBeforeTheFirstTimedRun) {
  Drawer drawer(scene_of_everything());
  std::vector<std::uint32_t> lights;
  for (std::uint32_t light = 0; light < drawer.scene.lights.size(); ++light)
    if (raster::has_map_for(GetParam(), drawer.scene.lights[light].type)) lights.push_back(light);
  raster::RasterOptions options = timed(GetParam());
  for (const int runs : {3, 1, 0}) {
    options.runs = runs, options.shadow_cost = runs > 0;
    drawer.draw(options, lights);
    if (modules.empty()) GTEST_SKIP() << "no driver that translates by a shared LLVM";
    for (const auto& [stage, count] : modules)
      EXPECT_TRUE(stage == "driver translation" || runs == 0) << runs << " runs: " << found();
  }
}

INSTANTIATE_TEST_SUITE_P(Techniques, DriverTranslation,
                         testing::Values(raster::Technique::hard, raster::Technique::pcf,
                                         raster::Technique::pcss, raster::Technique::vsm,
                                         raster::Technique::esm, raster::Technique::evsm,
                                         raster::Technique::msm, raster::Technique::second_depth,
                                         raster::Technique::midpoint, raster::Technique::csm,
                                         raster::Technique::lispsm, raster::Technique::cube,
                                         raster::Technique::izb, raster::Technique::hybrid));

}  // namespace
}  // namespace gnomon::test
