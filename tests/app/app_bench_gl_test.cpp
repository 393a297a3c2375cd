// gnomon bench: what it is told holds for each of its kinds; and --json makes the folder that it needs, here and elsewhere.
#include <gtest/gtest.h>
#include <stdio.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

/// What a shell's command says on stdout.
std::string said_by(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "no shell";
  std::string out;
  for (char buffer[4096]; const std::size_t count = fread(buffer, 1, sizeof buffer, pipe);)
    out.append(buffer, count);
  pclose(pipe);
  return out;
}

// The benchmark is a program of its own, which here only says its words and is ended as Ctrl-C or kill would.
TEST(WholeBench, TakesTheWordsAndCanBeEnded) {
  const TemporaryFolder folder;
  fs::copy_file(gnomon::test::program(), folder / "gnomon");
  fs::copy_file(fs::path(gnomon::test::program()).replace_filename("gnomon-bench"), folder / "gnomon-bench");
  write_text(folder / "gnomon_bench", "#!/bin/sh\necho \"$@\"\nkill -TERM $$\necho survived\n");
  fs::permissions(folder / "gnomon_bench", fs::perms::owner_all);
  const std::string program = "'" + folder / "gnomon" + "' bench --json ";
  EXPECT_EQ(said_by(program + "- 2>/dev/null"), "--json -\n");
  const std::string refused = said_by(program + "'" + folder / "gnomon" + "/rows.json' 2>&1");
  EXPECT_NE(refused.find("cannot write here"), std::string::npos) << refused;
}

TEST(TechniqueBench, HeedsWhatItIsTold) {
  const TemporaryFolder folder;
  write_text(folder / "part.json", R"({"schema": "gnomon/scene/1",
    "camera": {"eye": [0, 4, 8], "target": [0, 0, 0]},
    "lights": [{"name": "sun", "type": "directional", "direction": [-1, -2, -0.5]}],
    "materials": [{"name": "m"}],
    "meshes": [{"name": "floor", "generate": {"kind": "floor", "size": [8, 8]}},
               {"name": "box", "generate": {"kind": "box"}}],
    "instances": [{"mesh": "floor", "material": "m"}, {"mesh": "box", "material": "m"}]})");
  fs::create_directory(folder / "inner");
  write_text(folder / "inner/scene.json", R"({"schema": "gnomon/scene/1", "include": ["../part.json"]})");
  const Words words{"bench",      "--techniques", "inner/scene.json", "--size", "40x30",
                    "--map-size", "64",           "--runs",           "1",      "--threads",
                    "2",          "--json",       "new/rows.json",    "-o",     "page/table.md",
                    "--quiet"};
  EXPECT_EQ(run_gnomon(words, {.folder = folder.path()}).exit_code, 3) << "outside the scene's folder";
  const ProcessResult result = run_gnomon(words + Words{"--allow-outside"}, {.folder = folder.path()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  const nlohmann::json rows = nlohmann::json::parse(read_file(folder / "new/rows.json"))["rows"];
  ASSERT_FALSE(rows.empty());
  for (const nlohmann::json& row : rows) EXPECT_EQ(row["threads"], 2) << row;
  const std::string page = read_file(folder / "page/table.md");
  EXPECT_NE(page.find("--runs 1 --threads 2"), std::string::npos) << page.substr(0, 400);
  EXPECT_NE(page.find("--allow-outside"), std::string::npos);
}

TEST(Json, GoesIntoAFolderThatIsYetToBeMade) {
  const TemporaryFolder folder;
  const std::vector<Words> calls{{"tune", "floating-box", "--technique", "hard", "--size", "40x30",
                                  "--max-error", "90%", "--map-size", "64", "--runs", "1"},
                                 {"verify", "--case", "1", "--rays", "1000"},
                                 {"bench", "stadium", "--accel", "bvh", "--size", "16x9", "--runs", "1"},
                                 {"plan", "floating-box", "--size", "40x30"},
                                 {"scenes"}};
  for (const Words& call : calls) {
    const std::string file = call.front() + "/new.json";
    const ProcessResult result = run_gnomon(call + Words{"--json", file}, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 0) << call.front() << ": " << result.err;
    EXPECT_TRUE(nlohmann::json::accept(read_file(folder / file))) << call.front();
  }
}

}  // namespace
}  // namespace gnomon::app_test
