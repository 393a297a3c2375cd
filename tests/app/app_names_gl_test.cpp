// Names from files and from the command line are data: they neither steer the terminal nor make lines of
// their own, wherever the program repeats them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scene/base/expected.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

const std::string evil = "\x1b[31mX\x07\x9b\u009b\nline";
const std::string evil_escaped = R"(\x1b[31mX\x07\x9b\xc2\x9b\nline)";

// Line breaks are the program's own where every line is one that it writes for harmless names, too.
void expect_plain(const std::string& text) {
  EXPECT_EQ(one_line(text), [&] {
    std::string lines = text;
    for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos; at += 2)
      lines.replace(at, 1, "\\n");
    return lines;
  }());
  EXPECT_EQ(text.find("\nline"), std::string::npos) << text;
}

TEST(Names, AreOneLineOfPlainText) {
  EXPECT_EQ(one_line(evil), evil_escaped);
  EXPECT_EQ(one_line("Gl\u00fchbirne \u65e5\u672c \U0001f526"), "Gl\u00fchbirne \u65e5\u672c \U0001f526");
  EXPECT_EQ(one_line("\xc0\x80\xed\xa0\x80\xf5"),
            R"(\xc0\x80\xed\xa0\x80\xf5)");  // overlong, surrogate, beyond
  EXPECT_EQ(one_line("tab\there\r\x7f"), R"(tab\there\r\x7f)");
}

TEST(Names, OfModelsAreEscapedInNotesAndTables) {
  const TemporaryFolder folder;
  write_text(folder / "e.mtl", "newmtl \x1b[31mX\x07\x9b\nKd 2 1 1\nd 0.5\nmap_Kd \x1b]0;t\x07q.png\n");
  write_text(folder / "e.obj",
             "mtllib e.mtl\nusemtl \x1b[31mX\x07\x9b\no \x1b[5mname\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const ProcessResult result = run_gnomon({"plan", folder / "e.obj"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_plain(result.err);
  expect_plain(result.out);
  EXPECT_NE(result.err.find(R"(Material '\x1b[31mX\x07\x9b': Kd)"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find(R"(\x1b[31mX)"), std::string::npos) << result.out;
}

TEST(Names, OfLightsAreEscapedInSummariesAndErrors) {
  const TemporaryFolder folder;
  write_text(folder / "lamp.json", R"({
    "schema": "gnomon/scene/1",
    "camera": {"eye": [0, 13, 13.5], "target": [0, 0, 0.6], "vertical_fov_degrees": 38},
    "lights": [{"name": "\u001b[31mred\nline", "type": "directional", "elevation_degrees": 42, "azimuth_degrees": 35}],
    "materials": [{"name": "grey"}],
    "meshes": [{"name": "floor", "generate": {"kind": "floor", "size": [24, 20]}}],
    "instances": [{"mesh": "floor", "material": "grey"}]})");
  const Words compare = Words{"compare", "-v", folder / "lamp.json", "-o", folder / "out"} + small;
  const ProcessResult result = run_gnomon(compare + Words{"--fail-above", "0%", "--bias", "0"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  expect_plain(result.out);
  expect_plain(result.err);
  EXPECT_NE(result.out.find(R"(\x1b[31mred\nline)"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find(R"(\x1b[31mred\nline)"), std::string::npos) << result.err;
  expect_one_line(run_gnomon(compare + Words{"--light", "green"}), 2, R"(allowed \x1b[31mred\nline)");
}

// What turns a line around is written out, and letters of any script stay.
TEST(Names, CannotTurnTheLineAround) {
  EXPECT_EQ(one_line("a\u202eb\u2066c\u2028d\u200fe"), R"(a\u202eb\u2066c\u2028d\u200fe)");
  EXPECT_EQ(one_line("\u05d0\u0628 \u0645\u06cc\u200c\u062e\u0648\u0627\u0647\u0645"),
            "\u05d0\u0628 \u0645\u06cc\u200c\u062e\u0648\u0627\u0647\u0645");
  EXPECT_EQ(plain_lines("a\n\tb\r\nc\rd\u009be\x1b[1m\x7f"), "a\n\tb\r\nc\\rd\\u009be\\x1b[1m\\u007f");
}

std::vector<std::string> texts_below(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() && extension != ".png" && extension != ".exr") paths.push_back(entry.path());
  }
  return paths;
}

// Everything that a capture says of itself, on every stream and in every file of text.
TEST(Names, OfCapturesAndScenesAreEscapedInAllOutputs) {
  const TemporaryFolder folder;
  write_text(folder / "lamp.json", R"({
    "schema": "gnomon/scene/1", "name": "scene\u001b[31m\u202e",
    "camera": {"eye": [0, 13, 13.5], "target": [0, 0, 0.6], "vertical_fov_degrees": 38},
    "lights": [{"name": "sun\u001b[31m\u202e\u009b\nline", "type": "directional", "elevation_degrees": 42, "azimuth_degrees": 35}],
    "materials": [{"name": "grey"}],
    "meshes": [{"name": "floor", "generate": {"kind": "floor", "size": [24, 20]}}],
    "instances": [{"mesh": "floor", "material": "grey"}]})");
  constexpr ImageSize size{64, 36};
  ASSERT_TRUE(write_exr(folder / "v.exr", size,
                        std::vector<Channel>{{"V", std::vector<float>(size.pixels(), 1.0f)}}));
  write_text(folder / "capture.json", R"({
    "schema": "gnomon/capture/1", "scene": "lamp.json", "size": [64, 36], "visibility": "v.exr",
    "renderer": {"name": "mine\u001b[31m\u202e\u009b\nline", "version": "\u001b]0;t\u0007\u2066",
                 "settings": {"a\u001b[5m\u202e": "b\u009b\u001b[31m"}}})");
  for (const Words& words :
       {Words{"judge", folder / "capture.json", "-o", folder / "out"},
        Words{"judge", folder / "capture.json", "--json", "-"},
        Words{"judge", folder / "capture.json", folder / "capture.json", "-o", folder / "two"},
        Words{"compare", folder / "lamp.json", "-o", folder / "drawn"} + small,
        Words{"sweep", folder / "lamp.json", "--bias", "0,1", "-o", folder / "swept"} + small,
        Words{"merge", folder / "swept", "-o", folder / "merged"},
        Words{"tune", folder / "lamp.json", "--technique", "hard", "--size", "64x36", "--map-size",
              "64:128:x2", "--max-error", "50%", "--json", folder / "tune.json"},
        Words{"shimmer", folder / "lamp.json", "--path", "orbit", "--frames", "2", "-o", folder / "moved",
              "--size", "64x36", "--map-size", "64"},
        Words{"plan", folder / "lamp.json", "--json", folder / "plan.json"},
        Words{"raster", folder / "lamp.json", "--size", "32x18", "-o", folder / "r.png", "--json",
              folder / "r.json"},
        Words{"raytrace", folder / "lamp.json", "--size", "32x18", "-o", folder / "t.png", "--json",
              folder / "t.json"},
        Words{"export", folder / "lamp.json", "-o", folder / "scene.gltf"}}) {
    const ProcessResult result = run_gnomon(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_plain(result.out);
    expect_plain(result.err);
  }
  for (const char* table : {"out/result.csv", "two/judge.csv", "drawn/result.csv"}) {
    const std::string text = read_file(folder / table);
    EXPECT_NE(text.find(R"(sun\x1b[31m\u202e\xc2\x9b\nline)"), std::string::npos) << text;
    EXPECT_EQ(plain_lines(text), text) << table;
  }
  for (const std::string& path : texts_below(folder.path())) {
    const std::string text = read_file(path);
    if (path.ends_with(".js") || path.ends_with(".html")) continue;  // of the page's own letters: below
    EXPECT_EQ(plain_lines(text), text) << path;
  }
  const auto result = nlohmann::json::parse(read_file(folder / "drawn/result.json"));
  EXPECT_EQ(result.at("lights").at(0).at("light").at("name"), "sun\x1b[31m\u202e\u009b\nline")
      << "the same when it is read";
  for (const char* page : {"out/report.html", "two/report.html", "drawn/report.html"}) {
    const std::string text = read_file(folder / page);
    EXPECT_FALSE(text.empty()) << page;
    for (const char* turns : {"\u202e", "\u2066", "\u009b", "\x1b"})
      EXPECT_EQ(text.find(turns), std::string::npos) << page;
  }
}

TEST(Names, OnTheCommandLineAreEscapedInErrors) {
  expect_one_line(run_gnomon({evil}), 2, evil_escaped);
  expect_one_line(run_gnomon({"compare", evil + ".json"}), 3, evil_escaped);
  expect_one_line(run_gnomon({"compare", "fence", "--technique", evil}), 2, evil_escaped);
  expect_one_line(run_gnomon({"compare", "fence", "--" + evil}), 2, evil_escaped);
}

TEST(Names, TooLongForAFolder) {
  const std::string long_name(5000, 'x');
  expect_one_line(run_gnomon({"raster", "fence", "-o", "x.png", "--shader-dir", long_name}), 3,
                  "File name too long");
}

// The script that goes to sbatch holds no line but the program's own.
TEST(Names, WithLineBreaksStayOutOfBatchScripts) {
  const TemporaryFolder folder;
  const std::string inside = folder / "a\n#SBATCH --wrap=id";
  expect_one_line(run_gnomon({"sweep", "fence", "--bias", "0,1", "--slurm", "2", "-o", inside}), 2,
                  "line break");
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace gnomon::app_test
