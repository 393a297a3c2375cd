// gnomon shimmer seen from outside: its files, its exit codes, and what it says of a wrong call.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app_process.h"

namespace gnomon::app_test {
namespace {

using nlohmann::json;

const Words quick = {"shimmer", "thin-wall", "--size", "192x108", "--map-size", "64", "--frames", "3"};

TEST(ShimmerProgram, WritesItsFolderWhole) {
  const TemporaryFolder folder;
  const ProcessResult result = run_gnomon(quick + Words{"--json", "-", "-o", folder / "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json printed = json::parse(result.out);
  EXPECT_EQ(printed["schema"], "gnomon/shimmer/1");
  EXPECT_EQ(printed["frames"], 3);
  EXPECT_EQ(result.out, read_file(folder / "out/result.json"));
  for (const char* name : {"report.html", "film-0-drawn.png", "film-0-truth.png", "film-0-flips.png"})
    EXPECT_FALSE(read_file(folder / "out" + "/" + name).empty()) << name;
}

TEST(ShimmerProgram, ThresholdDecidesTheExitCode) {
  const Words json_only = {"--json", "-", "--path", "drift", "--drift", "0.5,0.5"};
  const ProcessResult moved = run_gnomon(quick + json_only);
  ASSERT_EQ(moved.exit_code, 0) << moved.err;
  ASSERT_GT(json::parse(moved.out)["lights"][0]["flips"], 0);
  EXPECT_EQ(run_gnomon(quick + json_only + Words{"--fail-above", "0"}).exit_code, 1);
  EXPECT_EQ(run_gnomon(quick + json_only + Words{"--fail-above", "1000"}).exit_code, 0);
  EXPECT_EQ(run_gnomon(quick + json_only + Words{"--snap", "--fail-above", "0"}).exit_code, 0);
}

TEST(ShimmerProgram, WrongCallsAreOneLine) {
  const Words nothing = {"--json", "-"};
  expect_one_line(run_gnomon(quick + nothing + Words{"--path", "sun"}), 2, "no path of a camera");
  expect_one_line(run_gnomon(quick + nothing + Words{"--path", "walk,sun"}), 2, "one path for each");
  expect_one_line(run_gnomon(quick + nothing + Words{"--snap", "--technique", "csm"}), 2, "snaps by itself");
  expect_one_line(run_gnomon(quick + nothing + Words{"--path", "nowhere.json"}), 3, "nowhere.json");
}

}  // namespace
}  // namespace gnomon::app_test
