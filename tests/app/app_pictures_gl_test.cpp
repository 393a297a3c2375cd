// The pictures of gnomon raster and gnomon raytrace: what their names decide, what is said of their options, and that a
// signal ends their work.
#include <gtest/gtest.h>

#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

// The same channels as of a name in small letters.
TEST(Pictures, AnExtensionMayBeInCapitals) {
  const TemporaryFolder folder;
  for (const auto& [command, record] : {std::pair{"raster", "drawn.V"}, std::pair{"raytrace", "truth.V"}}) {
    const std::string path = folder / (std::string(command) + ".EXR");
    const ProcessResult made = run_gnomon({command, "acne-floor", "--size", "40x30", "-o", path});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto image = read_channels(path);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_NE(image->find(record), nullptr) << path;
  }
}

// The picture has all lights, and one of them has a size.
TEST(Pictures, OptionsOfALightThatIsDrawnHaveAnEffect) {
  const TemporaryFolder folder;
  write_text(folder / "two.json", R"({"schema": "gnomon/scene/1",
    "camera": {"eye": [0, 4, 8], "target": [0, 0, 0]},
    "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -0.5], "angular_diameter_degrees": 2},
               {"name": "star", "type": "directional", "direction": [1, -2, -0.5]}],
    "materials": [{"name": "m"}],
    "meshes": [{"name": "floor", "generate": {"kind": "floor", "size": [8, 8]}},
               {"name": "box", "generate": {"kind": "box"}}],
    "instances": [{"mesh": "floor", "material": "m"}, {"mesh": "box", "material": "m"}]})");
  const ProcessResult made =
      run_gnomon({"raster", folder / "two.json", "--technique", "pcss", "--light", "star", "--filter-samples",
                  "8", "--size", "40x30", "--map-size", "64", "-o", folder / "two.exr"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.err.find("has no effect"), std::string::npos) << made.err;
}

// Nothing is written until all rays are traced, so that nothing has to be waited for.
TEST(Pictures, AHeatMapIsInterruptedWhileItsRaysAreTraced) {
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon({"raytrace", "teapot", "--accel", "brute", "--heatmap", "triangles",
                                           "--size", "4096x4096", "-o", "heat.png"},
                                          {.folder = folder.path(), .interrupt_after_ms = 1000});
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace gnomon::app_test
