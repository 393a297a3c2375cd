// One world with one renderer, compared at many settings: making a renderer costs more than a small
// comparison.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "compare/compare.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {

struct OneWorld {
  Scene scene;
  World world;
  std::unique_ptr<raster::Renderer> renderer;

  explicit OneWorld(Scene made) : scene(std::move(made)), world(make_world(scene)) {
    auto context = raster::create_context(raster::Backend::automatic);
    if (!context) throw std::runtime_error(context.error().message());
    auto created = raster::Renderer::create(std::move(*context), world, plan_effects(scene));
    if (!created) throw std::runtime_error(created.error().message());
    renderer = std::move(*created);
  }
  OneWorld(const OneWorld&) = delete;
  OneWorld& operator=(const OneWorld&) = delete;

  /// Camera and lights are those that `scene` has now.
  compare::Comparison compare(const compare::CompareOptions& options) {
    auto result = compare::compare_world(world, *renderer, every_light(scene), options);
    if (!result) throw std::runtime_error(result.error().message());
    return std::move(*result);
  }
};

}  // namespace gnomon::test
