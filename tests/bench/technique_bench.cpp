// technique_bench: each technique's frame through raster::Renderer against a minimal OpenGL program
// that issues the same draw calls and nothing else (no checks, no records, no costs counted). The two take
// turns; the medians of their CPU times are compared, which other programs on the machine disturb little.
//   technique_bench [SCENE [TURNS]]     a built-in scene without analytic shapes, one directional light
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "bench_support.h"
#include "minimal_program.h"
#include "raster/renderer.h"
#include "raster/technique_traits.h"
#include "scene/base/timing.h"
#include "scene/load.h"

namespace gnomon::bench {
namespace {

template <class Act>
double cpu_of(const Act& act) {
  const double start = cpu_ms();
  act();
  return cpu_ms() - start;
}

struct Frames {
  double ours = 0.0, minimal = 0.0;  ///< ms of CPU time each
};

Frames race(const World& world, raster::Technique technique, int turns) {
  constexpr int frames = 6;
  raster::RasterOptions options;
  options.size = {640, 360};
  options.map.technique = technique;
  options.map.bias = raster::default_bias(options.map);
  options.map = raster::effective_options(options.map);
  options.analysis = false;
  auto renderer = must(raster::Renderer::create(must(raster::create_context(raster::Backend::automatic)),
                                                world, plan_effects(*world.scene)));
  MinimalProgram minimal(world, options);
  minimal.frame();
  const std::uint32_t light = 0;
  const auto render = [&](int runs) {
    options.runs = runs;
    must(renderer->render(options, {&light, 1}));
  };
  render(1);
  Times ours, theirs;
  for (int turn = 0; turn < turns; ++turn) {
    // What more timed runs cost: set-up, warm-up and reading back fall out of the difference.
    const double one = cpu_of([&] { render(1); });
    ours.runs.push_back((cpu_of([&] { render(1 + frames); }) - one) / frames);
    theirs.runs.push_back(cpu_of([&] {
                            for (int i = 0; i < frames; ++i) minimal.frame();
                          }) /
                          frames);
  }
  return {ours.median(), theirs.median()};
}

int run(const std::string& name, int turns) {
  Scene scene = must(load_scene(name));
  scene.lights.resize(std::min<std::size_t>(scene.lights.size(), 1));
  const World world = make_world(scene);
  if (!world.shapes.empty() || scene.lights.empty() || scene.lights[0].type != LightType::directional) {
    fmt::print(stderr, "{}: needs a directional light and no analytic shapes\n", name);
    return 1;
  }
  fmt::print("{:8} {:>10} {:>12} {:>7}\n", "", "Gnomon ms", "minimal ms", "ratio");
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    const bool minimal_has_it = traits.lights.has(LightType::directional) &&
                                traits.technique != raster::Technique::second_depth &&
                                traits.technique != raster::Technique::hybrid;
    if (!minimal_has_it) continue;
    const Frames ms = race(world, traits.technique, turns);
    fmt::print("{:8} {:10.2f} {:12.2f} {:7.3f}\n", traits.name, ms.ours, ms.minimal, ms.ours / ms.minimal);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  return gnomon::bench::run(argc > 1 ? argv[1] : "courtyard",
                            argc > 2 ? std::max(1, std::atoi(argv[2])) : 10);
}
