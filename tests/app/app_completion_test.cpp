// What the shells offer: the values of an option where it has some, as the parser takes them.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  char part[256];
  while (std::fgets(part, sizeof part, pipe) != nullptr) text += part;
  pclose(pipe);
  return text;
}

bool is_there(const std::string& program) {
  return !output_of("command -v " + program).empty();
}

class Completion : public ::testing::Test {
 protected:
  Completion() {
    for (const char* shell : {"bash", "zsh", "fish"})
      write_text(folder / shell, run_gnomon({"--completion", shell}).out);
  }
  /// The offers of bash for the words so far, one a line.
  std::string in_bash(const std::string& words) const {
    return output_of(
        "cd " + folder.path() + " && bash -c 'source ./bash; COMP_WORDS=(" + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _gnomon; printf \"%s\\n\" \"${COMPREPLY[@]}\"'");
  }
  std::string in_fish(const std::string& line) const {
    return output_of("cd " + folder.path() + " && HOME=" + folder.path() +
                     " fish -c 'source ./fish; complete -C \"" + line + "\" | cut -f 1'");
  }
  TemporaryFolder folder;
};

TEST_F(Completion, BashOffersValues) {
  EXPECT_EQ(in_bash("gnomon comp"), "compare\n");
  EXPECT_EQ(in_bash("gnomon hel"), "help\n");
  EXPECT_EQ(in_bash("gnomon vers"), "version\n");
  EXPECT_EQ(in_bash("gnomon help ra"), "raster\nraytrace\n");
  EXPECT_EQ(in_bash("gnomon compare fen"), "fence\n");
  EXPECT_EQ(in_bash("gnomon compare fence --size \"\""), "720p\n1080p\n1440p\n4k\n8k\n");
  EXPECT_EQ(in_bash("gnomon compare --tech"), "--technique\n");
  EXPECT_EQ(in_bash("gnomon compare fence --technique pc"), "pcf\npcss\n");
  EXPECT_EQ(in_bash("gnomon compare fence --technique = mid"), "midpoint\n");  // --technique=mid
  EXPECT_EQ(in_bash("gnomon raster fence --depth-format d32"), "d32f\nd32f-reversed\n");
  EXPECT_EQ(in_bash("gnomon raytrace fence --precision \"\""), "fast\nrobust\nexact\n");
  EXPECT_EQ(in_bash("gnomon compare fence --accel kd"), "kdtree\nkdtree-cyclic\n");
  EXPECT_EQ(in_bash("gnomon sweep fence --technique hard,ms"), "hard,msm\n");
  EXPECT_EQ(in_bash("gnomon sweep fence --receiver-plane o"), "off\non\n");
  EXPECT_EQ(in_bash("gnomon compare fence --bias \"\""), "\n");  // a number: nothing to offer
  EXPECT_EQ(in_bash("gnomon --completion \"\""), "bash\nzsh\nfish\n");
  EXPECT_EQ(in_bash("gnomon --manual o"), "options\n");
  EXPECT_EQ(in_bash("gnomon grade fe"), "\n") << "a rubric is no scene";
  EXPECT_EQ(in_bash("gnomon compare fence -o fi"), "fish\n");  // a path: the folder's files
}

TEST_F(Completion, FishOffersValues) {
  if (!is_there("fish")) GTEST_SKIP() << "fish is not installed";
  EXPECT_EQ(in_fish("gnomon compare fence --technique pc"), "pcf\npcss\n");
  EXPECT_EQ(in_fish("gnomon compare fence --depth-format d32"), "d32f\nd32f-reversed\n");
  EXPECT_EQ(in_fish("gnomon sweep fence --technique hard,ms"), "hard,msm\n");
  EXPECT_NE(in_fish("gnomon compare fe").find("fence"), std::string::npos);
  EXPECT_EQ(in_fish("gnomon help ra"), "raster\nraytrace\n");
}

TEST_F(Completion, ZshTakesTheScript) {
  const std::string script = read_file(folder / "zsh");
  EXPECT_NE(script.find(":technique:(hard pcf pcss "), std::string::npos);
  EXPECT_NE(script.find(":technique:_sequence compadd - hard pcf pcss "), std::string::npos);
  EXPECT_NE(script.find(":output:_files"), std::string::npos);
  if (!is_there("zsh")) GTEST_SKIP() << "zsh is not installed";
  EXPECT_EQ(output_of("zsh -n " + folder / "zsh" + " 2>&1"), "");
}

// Every value that is offered is one that the parser takes.
TEST_F(Completion, OffersOnlyWhatIsTaken) {
  const std::regex entry(
      R"re(complete -c gnomon -n '__fish_seen_subcommand_from (compare|raytrace|bench)' -l ([a-z-]+) -x -a '([^'(]+)')re");
  const std::string script = read_file(folder / "fish");
  int offers = 0;
  for (std::sregex_iterator found(script.begin(), script.end(), entry), end; found != end; ++found) {
    std::istringstream values((*found)[3].str());
    for (std::string value; values >> value; ++offers) {
      const ProcessResult result =
          run_gnomon({(*found)[1], "nothing-of-this-name", "--" + (*found)[2].str(), value});
      EXPECT_EQ(result.err.find("unknown value"), std::string::npos) << result.err;
    }
  }
  EXPECT_GE(offers, 40);
}

}  // namespace
}  // namespace gnomon::app_test
