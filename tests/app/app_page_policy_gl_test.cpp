// Every page that the program writes has a content-security policy, by which no script runs but the program's own.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

int expect_policies(const std::string& folder, const std::string& command) {
  int pages = 0;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    if (file.path().extension() != ".html") continue;
    ++pages;
    const std::string policy = policy_of(read_file(file.path().string()));
    for (const char* part :
         {"default-src 'none'", "style-src 'sha256-", "script-src '", "form-action 'none'"})
      EXPECT_NE(policy.find(part), std::string::npos) << command << ": " << file.path() << ": " << part;
    EXPECT_EQ(policy.find("unsafe"), std::string::npos) << command << ": " << file.path();
  }
  return pages;
}

TEST(PagePolicy, EveryKindOfPageHasOne) {
  const TemporaryFolder folder;
  const Words quick{"--size", "64x36", "--map-size", "64"};
  write_text(folder / "rubric.json", R"({"schema": "gnomon/rubric/1", "title": "One", "technique": "hard",
    "hand_in": ["technique/hard.glsl"], "checks": [{"name": "draws", "points": 1, "kind": "draws",
    "runs": [{"scene": "acne-floor", "options": {"size": "64x36", "map-size": "64"}}]}]})");
  const std::vector<Words> commands = {
      Words{"compare", "acne-floor", "--runs", "1"} + quick,
      Words{"compare", "acne-floor", "--technique", "hybrid", "--runs", "1"} + quick,
      Words{"sweep", "acne-floor", "--size", "64x36", "--map-size", "64,128", "--runs", "1"},
      Words{"shimmer", "acne-floor", "--frames", "2"} + quick,
      Words{"tune", "acne-floor", "--technique", "hard", "--max-error", "90%"} + quick,
      Words{"lessons", "--only", "precision"},
      Words{"lessons", "--lecture", "shadows"},
      Words{"grade", "rubric.json"}};
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::string out = "out" + std::to_string(i), name = commands[i][0];
    const ProcessResult result = run_gnomon(commands[i] + Words{"-o", out, "-q"}, {.folder = folder.path()});
    ASSERT_EQ(result.exit_code, 0) << name << ": " << result.err;
    EXPECT_GT(expect_policies(folder / out, name), 0) << name;
  }
}

// A page that is put together elsewhere would lack it.
TEST(PagePolicy, NoSourceBeginsAPageWithoutIt) {
  const std::string root = gnomon::test::source_dir();
  for (const char* room : {"app", "benchmark", "compare", "functions", "grade", "hybrid", "judge", "lab",
                           "platform", "raster", "raytrace", "report", "scene", "studies", "verify"}) {
    for (const auto& file : fs::recursive_directory_iterator(root + "/" + room)) {
      if (file.path().extension() != ".cpp") continue;
      const std::string text = read_file(file.path().string());
      if (text.find("<!doctype") == std::string::npos && text.find("<html") == std::string::npos) continue;
      EXPECT_NE(text.find("page_head("), std::string::npos) << file.path();
    }
  }
}

}  // namespace
}  // namespace gnomon::app_test
