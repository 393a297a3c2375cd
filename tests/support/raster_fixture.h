// One scene drawn by the rasterizer, for the tests: the scene, its world and the frame, kept together.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "raster/renderer.h"
#include "tests/support/raster_reference.h"
#include "tests/support/raster_scenes.h"

namespace gnomon::test {

inline std::unique_ptr<raster::Context> software_context() {
  auto context = raster::create_context(raster::Backend::automatic);
  if (!context) ADD_FAILURE() << context.error().message();
  return context ? std::move(*context) : nullptr;
}

/// Keeps the addresses that World and Renderer hold on to.
struct Drawn {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<World> world;
  std::unique_ptr<raster::Renderer> renderer;
  raster::RasterFrame frame;

  const raster::LightRecord& light(std::size_t i = 0) const { return frame.lights[i]; }
  View view() const { return make_view(scene->camera, frame.options.size); }

  void render(const raster::RasterOptions& options) {
    std::vector<std::uint32_t> lights;
    for (std::uint32_t i = 0; i < scene->lights.size(); ++i) lights.push_back(i);
    auto result = renderer->render(options, lights);
    ASSERT_TRUE(result.has_value()) << result.error().message();
    frame = std::move(*result);
  }
};

inline raster::RasterOptions small_options(int map_size = 256) {
  raster::RasterOptions options;
  options.size = {192, 128};
  options.map.size = map_size;
  options.map.bias = {0.0, raster::BiasUnit::texel};
  options.runs = 0;
  return options;
}

inline Drawn make_drawn(Scene scene, InstanceChoice instances = InstanceChoice::automatic) {
  Drawn drawn;
  drawn.scene = std::make_unique<Scene>(std::move(scene));
  drawn.world = std::make_unique<World>(make_world(*drawn.scene, instances));
  auto context = software_context();
  if (context == nullptr) return drawn;
  auto renderer = raster::Renderer::create(std::move(context), *drawn.world, plan_effects(*drawn.scene));
  if (!renderer) {
    ADD_FAILURE() << renderer.error().message();
    return drawn;
  }
  drawn.renderer = std::move(*renderer);
  return drawn;
}

inline Drawn draw(Scene scene, const raster::RasterOptions& options = small_options(),
                  InstanceChoice instances = InstanceChoice::automatic) {
  Drawn drawn = make_drawn(std::move(scene), instances);
  if (drawn.renderer != nullptr) drawn.render(options);
  return drawn;
}

}  // namespace gnomon::test
