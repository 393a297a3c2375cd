#include "tests/support/compare_support.h"

#include <fstream>
#include <iterator>

#include "tests/support/small_scenes.h"

namespace gnomon::test {

Compared run_comparison(Scene scene, const compare::CompareOptions& options,
                        const std::string& shader_folder) {
  Compared out;
  out.scene = std::make_unique<Scene>(std::move(scene));
  out.world = std::make_unique<World>(make_world(*out.scene));
  auto context = raster::create_context(raster::Backend::automatic);
  if (!context) {
    ADD_FAILURE() << context.error().message();
    return out;
  }
  auto renderer =
      raster::Renderer::create(std::move(*context), *out.world, plan_effects(*out.scene), shader_folder);
  if (!renderer) {
    ADD_FAILURE() << renderer.error().message();
    return out;
  }
  auto result = compare::compare_world(*out.world, **renderer, every_light(*out.scene), options);
  if (!result) {
    ADD_FAILURE() << result.error().message();
    return out;
  }
  out.result = std::move(*result);
  return out;
}

compare::CompareOptions test_options(ImageSize size, int map_size, double bias_world) {
  compare::CompareOptions options;
  options.raster.size = options.raytrace.size = size;
  options.raster.map.size = map_size;
  options.raster.map.bias = {bias_world, raster::BiasUnit::world};
  options.raster.runs = 0;
  options.raytrace.picture = false;
  options.perceptual = false;
  return options;
}

void write_between_marks(const std::string& path, const std::string& name, const std::string& text) {
  std::ifstream in(path);
  std::string file{std::istreambuf_iterator<char>(in), {}};
  const std::string from = "<!-- " + name + " -->\n", to = "<!-- end of the " + name + " -->";
  const std::size_t start = file.find(from), end = file.find(to);
  ASSERT_TRUE(start != file.npos && end != file.npos) << path << " lacks the marks";
  file.replace(start + from.size(), end - start - from.size(), text);
  std::ofstream(path) << file;
}

double acne_fraction(double a, double b, double bias) {
  if (a < b) std::swap(a, b);
  if (bias < 0.0) return 1.0 - acne_fraction(a, b, -bias);
  if (bias >= a + b) return 0.0;
  if (bias <= a - b) return 0.5 * (1.0 - bias / a);
  return (a + b - bias) * (a + b - bias) / (8.0 * a * b);
}

}  // namespace gnomon::test
