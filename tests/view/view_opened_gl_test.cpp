// The shadow lab and the scenes that it opens and writes: what belongs to one scene is not taken for another's, and no
// file is lost.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "tests/view/view_lab_fixture.h"

namespace gnomon::app_test {
namespace {

const std::string small_window = "set panels off\nset size 96x64\nset map-size 64\n";

/// A ball over a floor. `more`: the camera and the lights.
std::string ball_over_floor(const std::string& more) {
  return R"({"schema": "gnomon/scene/1", "materials": [{"name": "grey"}], "shapes": [
  {"material": "grey", "plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}},
  {"material": "grey", "sphere": {"center": [0, 1, 0], "radius": 0.5}}], )" +
         more + "}";
}

constexpr const char* camera = R"("camera": {"eye": [0, 3, 6], "target": [0, 0, 0]})";

/// Twelve lamps, l0 to l11, of which the first four are faint.
std::string twelve_lamps() {
  std::string lights;
  for (int i = 0; i < 12; ++i)
    lights += fmt::format(
        R"({}{{"name": "l{}", "type": "point", "position": [{}, 2, 0.5], "intensity": [{}, {}, {}]}})",
        i == 0 ? "" : ", ", i, 0.1 * i - 0.5, i < 4 ? 0.01 : 10, i < 4 ? 0.01 : 10, i < 4 ? 0.01 : 10);
  return ball_over_floor(std::string(camera) + R"(, "lights": [)" + lights + "]");
}

TEST_F(ViewLab, TheCameraOfOneSceneIsNotAnothers) {
  write_text(folder_ / "two.json", ball_over_floor(R"("cameras": [
    {"name": "side", "eye": [6, 3, 0], "target": [0, 0, 0]},
    {"name": "front", "eye": [0, 3, 6], "target": [0, 0, 0]}])"));
  const Words said =
      printed("two.json", small_window + "print\nopen floating-box\nprint\n", {"--camera", "front"});
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].find("--camera front"), std::string::npos) << said[0];
  EXPECT_EQ(said[1].find("--camera "), std::string::npos) << said[1];
}

// Eight lights are kept, l4 to l11.
TEST_F(ViewLab, ALightOfVeryManyIsPickedByItsName) {
  write_text(folder_ / "many.json", twelve_lamps());
  const ProcessResult result =
      drive("floating-box", small_window +
                                "open many.json\nset light l5\nprint\nsave-scene saved.json\n"
                                "set light l2\n");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.out.find("--light l5"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("script.txt:8: light: "), std::string::npos) << result.err;
  const std::string left_out = ", without 4 lights that --max-lights leaves out";
  EXPECT_NE(result.err.find("note: saved saved.json" + left_out), std::string::npos) << result.err;
  const std::string saved = read_file(folder_ / "saved.json");
  EXPECT_NE(saved.find("\"l11\""), std::string::npos);
  EXPECT_EQ(saved.find("\"l2\""), std::string::npos);
}

TEST_F(ViewLab, ASceneThatTheScriptOpensIsNotWrittenOver) {
  const std::string mine = ball_over_floor(camera);
  write_text(folder_ / "mine.json", mine);
  for (const char* verb : {"open", "drop"}) {
    const ProcessResult result =
        drive("floating-box", fmt::format("{} mine.json\nsave-scene mine.json\n", verb), {"--quiet"});
    expect_one_line(result, 2, "script.txt:2: this file is also an input");
    EXPECT_EQ(read_file(folder_ / "mine.json"), mine) << verb;
  }
}

TEST_F(ViewLab, ACameraThatSeesNothingIsRefused) {
  write_text(folder_ / "above.json",
             ball_over_floor(R"("camera": {"eye": [0, 6, 0], "target": [0, 0, 0], "up": [0, 0, -1]})"));
  expect_one_line(drive("above.json", "quit\n", {"--camera-up", "0,1,0", "--quiet"}), 2,
                  "the camera's pose: camera.");
}

// The display is one of this test's own, and ends while the window is open.
TEST_F(ViewLab, ADisplayThatGoesAwayIsSaid) {
  auto display = std::make_unique<VirtualDisplay>();
  ProcessOptions options;
  options.folder = folder_.path();
  options.environment = {display->variable(), "WAYLAND_DISPLAY="};
  write_text(folder_ / "script.txt", small_window + "screenshot shown.png\nwait 1000000\n");
  std::thread ends([&] {
    for (int i = 0; i < 1200 && !std::filesystem::exists(folder_ / "shown.png"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    display.reset();
  });
  const ProcessResult result = run_gnomon({"view", "floating-box", "--script", "script.txt"}, options);
  ends.join();
  EXPECT_EQ(result.exit_code, 5) << result.err;
  EXPECT_NE(result.err.find("gnomon: the display is gone"), std::string::npos) << result.err;
}

TEST_F(ViewLab, ASavedSceneCanBeSwept) {
  printed("floating-box", small_window + "set receiver-plane on\nsave-scene saved.json\n");
  const ProcessResult swept =
      run({"sweep", "saved.json", "--map-size", "16,32", "--size", "32x18", "-o", "swept"});
  EXPECT_EQ(swept.exit_code, 0) << swept.err;
}

}  // namespace
}  // namespace gnomon::app_test
