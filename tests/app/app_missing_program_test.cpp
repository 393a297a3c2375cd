// gnomon alone, without the programs beside it: what needs one of them says which, in one line.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

class ProgramAlone : public ::testing::Test {
 protected:
  ProgramAlone() { fs::copy_file(gnomon::test::program(), folder_ / "gnomon"); }
  ProcessResult run(const Words& words) const {
    return run_gnomon(words, {.folder = folder_.path(), .program = folder_ / "gnomon"});
  }
  const TemporaryFolder folder_;
};

TEST_F(ProgramAlone, SaysWhichProgramHasTheCommand) {
  for (const Words& words :
       {Words{"judge", "x"}, {"judge"}, {"judge", "--help"}, {"--help", "judge"}, {"-h", "judge"}})
    expect_one_line(run(words), 5, "judge is a command of gnomon-judge, which is not beside this program");
  expect_one_line(run({"view", "fence"}), 5, "view is a command of gnomon-lab");
  expect_one_line(run({"--help", "sweep"}), 5, "sweep is a command of gnomon-studies");
}

TEST_F(ProgramAlone, SaysWhichProgramDescribesTheOthersCommands) {
  for (const Words& words : {Words{"--completion", "bash"},
                             {"--completion", "zsh"},
                             {"--completion", "fish"},
                             {"--manual"},
                             {"--manual", "options"},
                             {"--man-page"}})
    expect_one_line(run(words), 5, "which is not beside this program");
}

// A folder of that name, or a file that nobody may run, is no program either.
TEST_F(ProgramAlone, TakesNothingElseForTheProgram) {
  const std::string line = "judge is a command of gnomon-judge";
  fs::create_directory(folder_ / "gnomon-judge");
  expect_one_line(run({"judge", "x"}), 5, line);
  fs::remove(folder_ / "gnomon-judge");
  write_text(folder_ / "gnomon-judge", "not a program");
  expect_one_line(run({"judge", "x"}), 5, line);
  expect_one_line(run({"--help", "judge"}), 5, line);
}

TEST_F(ProgramAlone, DoesWhatIsItsOwn) {
  for (const Words& words : {Words{"--help"}, {"--version"}, {"--help", "compare"}, {"scenes"}}) {
    const ProcessResult result = run(words);
    EXPECT_EQ(result.exit_code, 0) << words.front() << ": " << result.err;
    EXPECT_NE(result.out, "");
  }
  EXPECT_NE(run({"--help"}).out.find("judge"), std::string::npos) << "every command is listed";
}

}  // namespace
}  // namespace gnomon::app_test
