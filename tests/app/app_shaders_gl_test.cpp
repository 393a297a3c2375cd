// A class that edits the shaders (gnomon shaders, --shader-dir): what it leaves alone is the program's own,
// what it replaced is told, and a mistake is one line with the file and, where there is one, the line.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "raster/programs/shader_folder.h"
#include "scene/files/encodings.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

using nlohmann::json;

const std::string head =
    "float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {\n";

class ShaderFolder : public ::testing::Test {
 protected:
  ProcessResult gnomon(const Words& words) const { return run_gnomon(words, {.folder = folder.path()}); }
  ProcessResult draw(const std::string& image, const Words& more = {"--shader-dir", "mine"}) const {
    return gnomon(Words{"raster", "acne-floor", "--size", "64x36", "--map-size", "64", "-o", image} + more);
  }
  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder / ("mine/" + name);
    std::filesystem::create_directories(path.parent_path());
    write_text(path.string(), text);
  }
  void write_hard(const std::string& body) const { write("technique/hard.glsl", head + body + "\n}\n"); }
  std::string bytes(const std::string& image) const { return read_file(folder / image); }
  TemporaryFolder folder;
};

TEST_F(ShaderFolder, HoldsTheOriginalsFirst) {
  ASSERT_EQ(draw("own.png", {}).exit_code, 0);
  const ProcessResult written = gnomon({"shaders", "-o", "mine"});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  for (const raster::ShaderFile& file : raster::own_shaders())
    EXPECT_EQ(bytes("mine/" + std::string(file.name)), file.text);
  const ProcessResult same = draw("same.png");
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_NE(same.err.find("every shader in it is the program's own"), std::string::npos) << same.err;
  EXPECT_EQ(bytes("own.png"), bytes("same.png"));
  write_hard("  return 1.0;");
  expect_one_line(gnomon({"shaders", "-o", "mine"}), 4, "technique/hard.glsl: is there already and differs");
  EXPECT_NE(gnomon({"shaders"}).out.find("technique/hard.glsl "), std::string::npos);
}

TEST_F(ShaderFolder, TellsWhatItReplaced) {
  write_hard("  return 0.0;");
  ASSERT_EQ(draw("own.png", {}).exit_code, 0);
  const ProcessResult dark = draw("dark.png", {"--shader-dir", "mine", "--json", "dark.json", "-q"});
  ASSERT_EQ(dark.exit_code, 0) << dark.err;
  EXPECT_NE(bytes("own.png"), bytes("dark.png"));
  const json expected = json::array(
      {{{"replaced", "technique/hard.glsl"}, {"sha256", sha256_hex(bytes("mine/technique/hard.glsl"))}}});
  EXPECT_EQ(json::parse(bytes("dark.json"))["shaders"], expected);
  const Words compare =
      Words{"compare", "acne-floor", "--shader-dir", "mine", "--json", "-", "-o", "out"} + small;
  const ProcessResult compared = gnomon(compare + Words{"--quiet"});
  ASSERT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_EQ(json::parse(compared.out)["shaders"], expected);
  EXPECT_NE(bytes("out/report.html").find(expected[0]["sha256"].get<std::string>()), std::string::npos);
  EXPECT_EQ(json::parse(gnomon(Words{"compare", "acne-floor", "--json", "-", "-q"} + small).out)["shaders"],
            json::array());
}

TEST_F(ShaderFolder, FilesThatReplaceNothing) {
  write("hard.glsl", head + "  return 0.0;\n}\n");
  expect_one_line(draw("bad.png"), 3,
                  "mine/hard.glsl: replaces no shader of the program; did you mean technique/hard.glsl?");
  std::filesystem::rename(folder / "mine/hard.glsl", folder / "mine/notes.txt");  // no shader
  write("technique/pcf_bxo.glsl", "");
  expect_one_line(draw("bad.png"), 3, "technique/pcf_box.glsl");
  std::filesystem::remove(folder / "mine/technique/pcf_bxo.glsl");
  write("technique/pcf_box.glsl", head + "  return 0.0;\n}\n");
  expect_one_line(draw("bad.png", {"--shader-dir", "mine", "-q"}), 3,
                  "pcf_box.glsl: replaces nothing here: --technique hard reads technique/hard.glsl");
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.png"));
  write_hard("  return 0.0;");
  const ProcessResult noted = draw("noted.png");
  EXPECT_EQ(noted.exit_code, 0);
  EXPECT_NE(noted.err.find("pcf_box.glsl replaces nothing here"), std::string::npos) << noted.err;
  expect_one_line(draw("bad.png", {"--shader-dir", "nowhere"}), 2, "no such folder (got nowhere)");
}

// Editors of Windows begin a file with it.
TEST_F(ShaderFolder, AByteOrderMarkIsSkipped) {
  const std::string mark = "\xef\xbb\xbf";
  write_hard("  return 0.0;");
  ASSERT_EQ(draw("dark.png").exit_code, 0);
  write("shadow.glsl", mark + "float nothing() { return 0.0; }\n");
  write("technique/hard.glsl", mark + "#include \"shadow.glsl\"\n" + head + "  return nothing();\n}\n");
  const ProcessResult marked = draw("marked.png");
  ASSERT_EQ(marked.exit_code, 0) << marked.err;
  EXPECT_EQ(bytes("marked.png"), bytes("dark.png"));
  // The hash is that of the file, as other programs take it.
  ASSERT_EQ(draw("again.png", {"--shader-dir", "mine", "--json", "again.json", "-q"}).exit_code, 0);
  EXPECT_NE(bytes("again.json").find(sha256_hex(bytes("mine/technique/hard.glsl"))), std::string::npos);
}

TEST_F(ShaderFolder, WithoutAShaderIsRefused) {
  write("technique/hard.glsl.txt", "");  // an editor of Windows, and an explorer that hides endings
  expect_one_line(draw("bad.png"), 3, "mine: holds no shader (names end in .glsl, .vert, .frag or .h)");
}

TEST_F(ShaderFolder, AnotherEncodingIsRefused) {
  write("technique/hard.glsl", std::string("\xff\xfe/\0/\0", 6));
  expect_one_line(draw("bad.png"), 3, "mine/technique/hard.glsl: is not UTF-8 text, but seems to be UTF-16");
}

TEST_F(ShaderFolder, AFaultOfLinkingIsOneCleanLine) {
  write("shade.frag", "float not_main() { return 0.0; }\n");
  const ProcessResult drawn = draw("bad.png");
  expect_one_line(drawn, 3, "shader shade.frag does not link: ");
  EXPECT_EQ(drawn.err.find("\\n"), std::string::npos) << drawn.err;
}

TEST_F(ShaderFolder, MistakesAreNamedWithFileAndLine) {
  write_hard("  return 0.0");
  expect_one_line(draw("bad.png"), 3, "mine/technique/hard.glsl:3: ");
  write_hard("  return nonsense(1.0);");
  expect_one_line(draw("bad.png"), 3, "mine/technique/hard.glsl:2: ");
  write_hard("  return 1.0;\n}\n#include \"tabs.glsl\"\nvoid f() {");
  expect_one_line(draw("bad.png"), 3, "mine/technique/hard.glsl:4: no such shader (got tabs.glsl");
  // A file of the user's own may be included.
  write("tabs.glsl", "float half_lit() {\n  return 0.5\n}\n");
  write("technique/hard.glsl", "#include \"tabs.glsl\"\n" + head + "  return half_lit();\n}\n");
  expect_one_line(draw("bad.png"), 3, "mine/tabs.glsl:3: ");
  write("tabs.glsl", "float half_lit() { return 0.5; }\n");
  EXPECT_EQ(draw("good.png").exit_code, 0);
}

TEST_F(ShaderFolder, MissingFunctionsAreNamedInPlainWords) {
  const std::string words =
      "hard.glsl: the function technique_visibility is missing: other shaders call it as the "
      "original defines it, float technique_visibility(ShadowTest test, vec3 position, "
      "vec3 normal, vec3 to_light)";
  write("technique/hard.glsl", "float visibility(ShadowTest test) { return 1.0; }\n");
  expect_one_line(draw("bad.png"), 3, words);
  write("technique/hard.glsl",
        "float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light);\n");
  expect_one_line(draw("bad.png"), 3, words);
}

TEST_F(ShaderFolder, ValuesThatAreNoVisibilityNameThePixel) {
  write_hard("  return ivec2(gl_FragCoord.xy) == ivec2(31, 17) ? 1.5 : 1.0;");
  expect_one_line(
      draw("bad.png"), 3,
      "hard.glsl: technique_visibility() gives no visibility at pixel (31, 17), counted from the top "
      "left (got 1.5, allowed 0 to 1)");
  write_hard("  return ivec2(gl_FragCoord.xy) == ivec2(30, 16) ? -0.25 : 1.0;");
  expect_one_line(draw("bad.png"), 3, "(30, 16), counted from the top left (got -0.25");
  write_hard("  return ivec2(gl_FragCoord.xy) == ivec2(31, 17) ? uintBitsToFloat(0x7fc00000u) : 1.0;");
  expect_one_line(gnomon(Words{"compare", "acne-floor", "-q", "-o", "out", "--shader-dir", "mine"} + small),
                  3, "pixel (31, 17), counted from the top left (got nan");
  write_hard("  return ivec2(gl_FragCoord.xy) == ivec2(31, 17) ? 1.000001 : 1.0;");  // rounding
  EXPECT_EQ(draw("good.png").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.png"));
}

// A cell of a sweep is what compare gives; nothing is derived from gaps that the shader may not look at.
// One process for many folders leaves nothing of one to the next; a mistake in one costs the others nothing.
TEST_F(ShaderFolder, EachOfManyDrawsWhatItDrawsAlone) {
  const std::map<std::string, std::string> bodies = {{"a", "  return 0.25;"},
                                                     {"b", "  return nothing;"},
                                                     {"c", "  return test.gap > 0.0 ? 0.0 : 1.0;"},
                                                     {"d", "  return test.gap > light.bias.x ? 0.0 : 0.75;"}};
  for (const auto& [name, body] : bodies) {
    write_hard(body);
    std::filesystem::create_directories(folder / "each");
    std::filesystem::rename(folder / "mine", folder / ("each/" + name));
  }
  const std::string lights = "\"lights\": [";
  std::string scene = read_file(gnomon::test::source_dir() + "/scene/builtin/sphere-plane.json");
  scene.insert(scene.find(lights) + lights.size(),
               R"({"name": "second", "type": "point", "position": [3, 2.6, 0.5]},)");
  write_text(folder / "two.json", scene);
  const Words call = Words{"compare", "two.json", "-o", "out", "--no-report", "--runs", "1", "-q"} + small;
  const ProcessResult all =
      run_gnomon(call + Words{"--aov", "all/v.exr"},
                 {.folder = folder.path(), .environment = {"GNOMON_EACH_SHADER_FOLDER=each"}});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  for (const auto& [name, body] : bodies) {
    const ProcessResult alone = gnomon(call + Words{"--shader-dir", "each/" + name, "--aov", "alone/v.exr"});
    EXPECT_EQ(alone.exit_code, name == "b" ? 3 : 0) << alone.err;
    EXPECT_EQ(std::filesystem::is_empty(folder / ("all/" + name)), name == "b");
    if (name == "b") continue;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "alone"), {}), 2)
        << "one file for each light";
    for (const auto& light : std::filesystem::directory_iterator(folder / "alone")) {
      const auto right = read_channels(light.path().string());
      const auto drawn = read_channels((folder / ("all/" + name)) + "/" + light.path().filename().string());
      ASSERT_TRUE(right.has_value() && drawn.has_value()) << name << light.path();
      const std::vector<float>& label = right->find("class.V")->values;
      std::size_t compared = 0;
      for (std::size_t i = 0; i < label.size(); ++i) {
        if (label[i] < 0.0f) continue;
        ++compared;
        EXPECT_EQ(drawn->find("drawn.V")->values[i], right->find("drawn.V")->values[i])
            << name << light.path();
      }
      EXPECT_GT(compared, 0u);
    }
  }
}

TEST_F(ShaderFolder, SweepsTakeIt) {
  write_hard("  return test.gap > 0.5 * light.bias.x ? 0.0 : 1.0;");
  const Words scene = {"floating-box", "--size", "64x36", "--map-size", "64", "--shader-dir", "mine"};
  const ProcessResult swept =
      gnomon(Words{"sweep"} + scene + Words{"--bias", "0.1,0.4", "-o", "swept", "-q"});
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  std::istringstream lines(bytes("swept/sweep.jsonl"));
  for (const char* bias : {"0.1", "0.4"}) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    const json cell = json::parse(line);
    EXPECT_NE(cell["command"].get<std::string>().find(" --shader-dir mine"), std::string::npos);
    const json alone = json::parse(
        gnomon(Words{"compare"} + scene + Words{"--bias", bias, "-o", "alone", "--json", "-", "-q"}).out);
    EXPECT_EQ(cell["shaders"], alone["shaders"]);
    EXPECT_EQ(cell["lights"][0]["classes"], alone["lights"][0]["classes"]) << bias;
  }
}

}  // namespace
}  // namespace gnomon::app_test
