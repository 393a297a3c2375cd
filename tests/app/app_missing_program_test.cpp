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
  for (const Words& words : {Words{"--manual"}, {"--manual", "options"}, {"--man-page"}})
    expect_one_line(run(words), 5, "which is not beside this program");
}

// A shell that starts gets what there is.
TEST_F(ProgramAlone, CompletesWhatThereIs) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const ProcessResult result = run({"--completion", shell});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* word : {"compare", "map-size", "judge"})
      EXPECT_NE(result.out.find(word), std::string::npos);
    EXPECT_NE(result.err.find("gnomon-judge, which is not beside this program; Gnomon's package, or"),
              std::string::npos)
        << result.err;
  }
}

// A folder of that name, or a file that is no program, is not it; each time it is said what to do.
TEST_F(ProgramAlone, TakesNothingElseForTheProgram) {
  const std::string line = "judge is a command of gnomon-judge, and ", path = folder_ / "gnomon-judge";
  const auto expect_said = [&](const std::string& end) {
    expect_one_line(run({"judge", "x"}), 5, line + path + end);
    expect_one_line(run({"help", "judge"}), 5, line + path + end);
  };
  fs::create_directory(path);
  expect_said(" is no file; Gnomon's package, or ./gnomon build in its sources, brings all its programs");
  EXPECT_EQ(run({"--completion", "bash"}).exit_code, 0);
  fs::remove(path);
  write_text(path, "not a program");
  expect_one_line(run({"judge", "x"}), 5,
                  line + path + " may not be executed; chmod +x " + path + " lets it");
  fs::permissions(path, fs::perms::owner_all);
  expect_said(" is not that program; Gnomon's package, or");
  // One that is there and fails may do so for want of something: what it has is not left out in silence.
  for (const char* program : {"not a program", "#!/bin/sh\nexit 5\n"}) {
    write_text(path, program);
    expect_one_line(run({"--completion", "bash"}), 5, path);
  }
}

// Programs that start each other would do so for ever: a link to gnomon in the place of another program, or a script that calls it.
TEST_F(ProgramAlone, DoesNotStartItselfInACircle) {
  const std::string path = folder_ / "gnomon-judge", said = path + " is not that program";
  fs::create_symlink("gnomon", path);
  for (const Words& words : {Words{"judge", "x"}, {"help", "judge"}}) expect_one_line(run(words), 5, said);
  expect_one_line(run_gnomon({"judge", "x"}, {.folder = folder_.path(), .program = path}), 5, said);
  EXPECT_EQ(run({"--completion", "bash"}).exit_code, 0);
  fs::remove(path);
  for (const char* start : {"", "exec "}) {
    write_text(path, "#!/bin/sh\n" + std::string(start) + folder_ / "gnomon" + " \"$@\"\n");
    fs::permissions(path, fs::perms::owner_all);
    expect_one_line(run({"judge", "x"}), 5, said);
    fs::remove(path);
  }
}

TEST_F(ProgramAlone, OneOfAnotherVersionIsNotTaken) {
  const std::string path = folder_ / "gnomon-judge",
                    judge = fs::path(gnomon::test::program()).parent_path() / "gnomon-judge";
  const std::string said = "gnomon-judge is of version ";
  // As it is started by a gnomon of another version.
  for (const char* version : {"0.0.1+abc", "0.0.1"}) {
    write_text(path, "#!/bin/sh\nGNOMON_STARTED_BY=\"$$ gnomon-judge " + std::string(version) + "\" exec " +
                         judge + " \"$@\"\n");
    fs::permissions(path, fs::perms::owner_all);
    const ProcessResult refused = run({"judge", "x"});
    expect_one_line(refused, 5, said);
    expect_one_line(refused, 5,
                    ", and what started it of " + std::string(version) + "; Gnomon's package, or");
  }
  // As it describes itself.
  write_text(path, "#!/bin/sh\necho '{\"version\": \"0.0.1\", \"commands\": {}}'\n");
  const ProcessResult completed = run({"--completion", "bash"});
  EXPECT_EQ(completed.exit_code, 0);
  EXPECT_NE(completed.err.find(said + "0.0.1, and this program of "), std::string::npos) << completed.err;
  // What somebody's environment holds is no start.
  const ProcessOptions stale{.folder = folder_.path(),
                             .environment = {"GNOMON_STARTED_BY=1 gnomon-judge 0.0.1"}};
  EXPECT_EQ(run_gnomon({"--version"}, stale).exit_code, 0);
}

// The signal reaches the program that gnomon has become.
TEST(ProgramStartedByName, EndsBySignalsAsGnomonDoes) {
  const TemporaryFolder folder;
  for (const auto& [signal, code] : {std::pair(2, 130), {15, 143}}) {
    const ProcessResult ended =
        run_gnomon({"serve", "acne-floor", "--port", "0"},
                   {.folder = folder.path(), .interrupt_after_ms = 300, .signal = signal});
    EXPECT_EQ(ended.exit_code, code) << ended.signal << " " << ended.err;
  }
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
