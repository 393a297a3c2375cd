// wrong_pixels SCENE [MAP_SIZE]: how many pixels a shadow map draws wrong, and why.
#include <cstdio>
#include <cstdlib>

#include "compare/compare.h"
#include "scene/load.h"

using namespace gnomon;

int fail_with(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return static_cast<int>(error.kind);
}

int main(int argc, char** argv) {
  const auto scene = load_scene(argc > 1 ? argv[1] : "fence");
  if (!scene) return fail_with(scene.error());
  const World world = make_world(*scene);
  const EffectPlan plan = plan_effects(*scene);
  const std::uint32_t lights[] = {0};

  compare::CompareOptions options;  // every field says its unit, range and default
  options.raster.size = options.raytrace.size = {640, 360};
  options.raster.map.size = argc > 2 ? std::atoi(argv[2]) : 1024;
  options.raytrace.picture = false;

  auto context = raster::create_context(raster::Backend::automatic);
  if (!context) return fail_with(context.error());
  auto renderer = raster::Renderer::create(std::move(*context), world, plan);
  if (!renderer) return fail_with(renderer.error());
  const auto compared = compare::compare_world(world, **renderer, lights, options);
  if (!compared) return fail_with(compared.error());

  const compare::LightComparison& light = compared->lights.front();
  std::printf("%llu of %llu pixels are wrong\n", static_cast<unsigned long long>(light.error.wrong),
              static_cast<unsigned long long>(light.pixels.compared));
  for (std::size_t i = 0; i < compare::class_count; ++i)
    std::printf("%8llu %s\n", static_cast<unsigned long long>(light.classes[i]),
                compare::label_name(static_cast<compare::Label>(i + 1)).data());
}
