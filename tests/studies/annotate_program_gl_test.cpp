// --annotate of every command that judges: workflow commands on stderr, test cases of JUnit in a file.
#include <gtest/gtest.h>

#include <array>

#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

void expect_parts(const std::string& text, const Words& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

TEST(Annotate, SaysEachLightOfAComparison) {
  const TemporaryFolder out;
  const Words compare = Words{"compare", "fence", "--quiet", "-o", out.path() + "/fence"} + small;
  const ProcessResult kept = run_gnomon(compare + Words{"--annotate", "github"});
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  expect_parts(kept.err, {"::notice title=fence%2C light sun::", " wrong"});
  const ProcessResult over = run_gnomon(compare + Words{"--annotate", "github", "--fail-above", "0.01%"});
  EXPECT_EQ(over.exit_code, 1) << over.err;
  expect_parts(over.err, {"::error title=fence%2C light sun::", "that is more than --fail-above 0.01%25\n"});
  const std::string file = out.path() + "/junit.xml";
  for (const Words& more : {Words{}, Words{"--json", "-"}}) {
    EXPECT_EQ(
        run_gnomon(compare + more + Words{"--annotate", "junit:" + file, "--fail-above", "0.01%"}).exit_code,
        1);
    expect_parts(read_file(file),
                 {"<testsuite name=\"gnomon compare\" tests=\"1\" failures=\"1\" errors=\"0\">",
                  "<testcase classname=\"fence\" name=\"light sun\">", "<failure message=\""});
    write_text(file, "");
  }
}

TEST(Annotate, SaysWhatADiffAndASweepFind) {
  const TemporaryFolder out;
  const std::string before = out.path() + "/before", after = out.path() + "/after",
                    file = out.path() + "/junit.xml";
  for (const auto& [folder, size] : {std::pair{before, "512"}, {after, "64"}})
    ASSERT_EQ(run_gnomon({"compare", "fence", "--size", "64x36", "--map-size", size, "--quiet", "-o", folder})
                  .exit_code,
              0);
  EXPECT_EQ(
      run_gnomon({"diff", before, after, "--quiet", "--fail-worse", "0.1%", "--annotate", "junit:" + file})
          .exit_code,
      1);
  expect_parts(read_file(file),
               {"\"gnomon diff\" tests=\"1\" failures=\"1\"", "<failure message=\"sun: wrong pixels "});
  EXPECT_EQ(run_gnomon({"diff", after, before, "--quiet", "--annotate", "junit:" + file}).exit_code, 0);
  expect_parts(read_file(file), {"failures=\"0\"", "<system-out>better; pixels: "});
  const ProcessResult sweep =
      run_gnomon({"sweep", "fence", "--size", "48x27", "--map-size", "64", "--bias", "0,0.1", "--quiet", "-o",
                  out.path() + "/sweep", "--max-error", "0.1%", "--annotate", "github"});
  EXPECT_EQ(sweep.exit_code, 1) << sweep.err;
  expect_parts(sweep.err, {"::error title=fence%2C --max-error 0.1%25::"});
}

// Captures of one scene are told apart by their names; one that cannot be read is an error.
TEST(Annotate, SaysEachCapture) {
  const TemporaryFolder out;
  for (const auto& [name, seen] : {std::pair{"lit", 1.0f}, {"dark", 0.0f}}) {
    const std::string picture = out.path() + "/" + name + ".exr";
    const std::array channels{Channel{"V", std::vector<float>(ImageSize{64, 36}.pixels(), seen)}};
    ASSERT_TRUE(write_exr(picture, {64, 36}, channels));
    write_text(
        out.path() + "/" + name + ".json",
        R"({"schema": "gnomon/capture/1", "renderer": {"name": "mine"}, "scene": "acne-floor", "size": [64, 36],
                   "visibility": ")" +
            std::string(name) + R"(.exr"})");
  }
  const ProcessResult judged = run_gnomon({"judge", "lit.json", "dark.json", "none.json", "--fail-above",
                                           "20%", "--quiet", "--annotate", "junit:junit.xml"},
                                          {.folder = out.path()});
  EXPECT_EQ(judged.exit_code, 3) << judged.err;
  expect_parts(
      read_file(out.path() + "/junit.xml"),
      {"\"gnomon judge\" tests=\"3\" failures=\"1\" errors=\"1\"", "classname=\"lit\" name=\"light sun\"",
       "classname=\"dark\" name=\"light sun\"", "classname=\"none\" name=\"capture\""});
}

TEST(Annotate, RefusesOtherForms) {
  for (const char* form : {"gitlab", "junit", "junit:", "github:x"})
    expect_one_line(run_gnomon({"compare", "fence", "--annotate", form}), 2, "github, junit:FILE");
  const TemporaryFolder out;
  write_text(out.path() + "/scene.json", "{}");
  expect_one_line(run_gnomon({"compare", out.path() + "/scene.json", "--annotate",
                              "junit:" + out.path() + "/scene.json"}),
                  2, "--annotate");
}

}  // namespace
}  // namespace gnomon::app_test
