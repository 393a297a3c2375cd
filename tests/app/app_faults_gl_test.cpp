// Faults of the surroundings, provoked: whatever happens, outputs are whole or not there, and one line says why.
// Others are provoked where their subject is tested: single calls that fail in every command by faults/campaign.py,
// /dev/full and file-size limits in scene_write_file_test.cpp, killed and torn sweeps in sweep_program_gl_test.cpp, too
// few threads and too little memory besides in app_few_resources_gl_test.cpp, a broken installation in app_cli_gl_test.cpp.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/support/app_process.h"
#include "tests/support/places.h"

namespace gnomon::app_test {
namespace {

namespace fs = std::filesystem;

Words compare_into(const std::string& folder) {
  return Words{"compare", "acne-floor", "-o", folder, "-q"} + small;
}

/// Complete, and nothing else beside it.
void expect_whole(const TemporaryFolder& folder, const std::string& name) {
  for (const char* file : {"report.html", "result.json", "result.csv", "raster.png", "raytrace.png"})
    EXPECT_TRUE(fs::exists(fs::path(folder / name) / file)) << name << "/" << file;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

void close_stdin() {
  close(STDIN_FILENO);
}

void break_stdout(bool ignore_signal) {
  int ends[2];
  if (pipe(ends) != 0) _exit(97);
  dup2(ends[1], STDOUT_FILENO);
  close(ends[0]), close(ends[1]);
  signal(SIGPIPE, ignore_signal ? SIG_IGN : SIG_DFL);
}

void become_nobody() {
  constexpr uid_t nobody = 65534;
  if (geteuid() == 0 && setresuid(nobody, nobody, nobody) != 0) _exit(97);
}

TEST(Faults, AClosedStdin) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_gnomon(compare_into("out"), {.folder = folder.path(), .prepare = close_stdin});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_whole(folder, "out");
}

// The table goes nowhere; the files were written before.
TEST(Faults, ABrokenPipe) {
  const TemporaryFolder folder;
  const Words words = Words{"compare", "acne-floor", "-o", "out"} + small;
  const ProcessResult ended =
      run_gnomon(words, {.folder = folder.path(), .prepare = [] { break_stdout(false); }});
  EXPECT_EQ(ended.signal, SIGPIPE) << ended.exit_code << ended.err;
  expect_whole(folder, "out");
  const ProcessResult told =
      run_gnomon(words, {.folder = folder.path(), .prepare = [] { break_stdout(true); }});
  EXPECT_EQ(told.exit_code, 4) << told.err;
  expect_whole(folder, "out");
}

// A locale of its own, made from Debian's sources, with decimal commas.
TEST(Faults, ALocaleWithCommas) {
  const TemporaryFolder folder;
  const std::string make = "localedef -c -i de_DE -f UTF-8 '" + (folder / "de_DE.utf8") + "' >/dev/null 2>&1";
  if (std::system(make.c_str()) != 0 && !fs::exists(folder / "de_DE.utf8"))
    GTEST_SKIP() << "no locale with decimal commas";
  for (const Words& words :
       {Words{"plan", "fence", "--json", "-", "--size", "64x36"}, Words{"scenes", "--json", "-"}}) {
    const ProcessResult plain = run_gnomon(words, {.environment = {"LC_ALL=C"}});
    const ProcessResult commas =
        run_gnomon(words, {.environment = {"LOCPATH=" + folder.path(), "LC_ALL=de_DE.utf8"}});
    EXPECT_EQ(plain.exit_code, 0) << plain.err;
    EXPECT_EQ(commas.out, plain.out) << words[0];
  }
  const ProcessResult read =
      run_gnomon({"raster", "acne-floor", "--bias", "0.25texel", "--size", "8x8", "-o", "a.png", "-q"},
                 {.folder = folder.path(), .environment = {"LOCPATH=" + folder.path(), "LC_ALL=de_DE.utf8"}});
  EXPECT_EQ(read.exit_code, 0) << read.err;
}

TEST(Faults, AFolderThatMayOnlyBeRead) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  chmod((folder / "out").c_str(), 0555);
  chmod(folder.path().c_str(), 0555);
  for (const Words& words :
       {compare_into("out"), compare_into("new"),
        Words{"raytrace", "acne-floor", "-o", "out/a.png", "-q"} + Words{"--size", "8x8"}}) {
    const ProcessResult result = run_gnomon(words, {.folder = folder.path(), .prepare = become_nobody});
    if (result.exit_code == 98) GTEST_SKIP() << "another user cannot run the program where it lies";
    expect_one_line(result, 4, "Permission denied");
  }
  chmod(folder.path().c_str(), 0755);
  EXPECT_EQ(folder.entries(), Words{"out/"});
}

TEST(Faults, LinksInACircleAndNoFolderForTemporaryFiles) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "suite");
  fs::create_symlink("capture.json", folder / "suite/capture.json");
  fs::create_symlink("round", folder / "suite/round");
  expect_one_line(run_gnomon({"judge", "--suite", folder / "suite"}), 3, "Too many levels of symbolic links");
  const Words bands{"compare", "acne-floor", "--size", "1280x720", "--memory", "150M", "--json", "-", "-q"};
  const ProcessResult compared =
      run_gnomon(bands, {.folder = folder.path(), .environment = {"TMPDIR=" + (folder / "none")}});
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
}

TEST(Faults, APipeInTheCapturesPlace) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "suite");
  ASSERT_EQ(mkfifo((folder / "suite/capture.json").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder / "frame.rdc").c_str(), 0600), 0);
  for (const Words& words : {Words{"judge", "--suite", "suite"}, Words{"judge", "frame.rdc"}}) {
    const ProcessResult judged = run_gnomon(words, {.folder = folder.path()});
    EXPECT_EQ(judged.exit_code, 3);
    EXPECT_NE(judged.err.find("is a pipe, not a file"), std::string::npos) << judged.err;
  }
}

TEST(Faults, OsmesaThatDoesNotLoadIsSaid) {
  const TemporaryFolder folder;
  const Words words{"raster", "acne-floor", "-o", "picture.png", "--size", "32x18", "--map-size", "64"};
  if (run_gnomon(words + Words{"--backend", "egl-software"}, {.folder = folder.path()}).exit_code != 0)
    GTEST_SKIP() << "no EGL in software here";
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so"}) folder.put(name, "no library");
  const auto run = [&](const Words& further) {
    return run_gnomon(words + further,
                      {.folder = folder.path(), .environment = {"LD_LIBRARY_PATH=" + folder.path()}});
  };
  const ProcessResult result = run({});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("OSMesa does not load"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("--backend egl-"), std::string::npos) << result.err;
  for (const Words& further : {Words{"-q"}, Words{"--backend", "egl-software"}}) {
    const ProcessResult silent = run(further);
    EXPECT_EQ(silent.exit_code, 0) << silent.err;
    EXPECT_EQ(silent.err.find("OSMesa"), std::string::npos) << silent.err;
  }
}

TEST(Faults, NeitherOsmesaNorEgl) {
  const TemporaryFolder folder;
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so", "libEGL.so.1", "libEGL.so"})
    write_text(folder / name, "");
  const ProcessResult result = run_gnomon(
      compare_into("out"), {.folder = folder.path(), .environment = {"LD_LIBRARY_PATH=" + folder.path()}});
  expect_one_line(result, 5, "osmesa: ");
  EXPECT_NE(result.err.find("egl"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

// In each case the other threads stop, and one line says what was thrown. Which allocation a number means depends on
// which thread comes first, and so does whether there are so many; the last number is beyond all.
TEST(Faults, AnErrorInOneThreadOfMany) {
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer has its own operator new";
  int ended = 0;
  for (const int allocation : {1, 2, 5, 13, 34, 89, 1 << 30}) {
    const TemporaryFolder folder;
    const ProcessResult result = run_gnomon(
        {"raytrace", "fence", "--size", "64x36", "-o", "a.png", "-q"},
        {.folder = folder.path(),
         .environment = {"LD_PRELOAD=" + test::fault_injector(), "GNOMON_FAULT_CALL=malloc",
                         "GNOMON_FAULT_WORKERS=1", "GNOMON_FAULT_AT=" + std::to_string(allocation)}});
    if (result.exit_code == 0) {
      EXPECT_EQ(folder.entries(), Words{"a.png"});
      continue;
    }
    ++ended;
    expect_one_line(result, 5, "out of memory");
    EXPECT_TRUE(folder.entries().empty());
  }
  EXPECT_TRUE(ended > 0 || std::thread::hardware_concurrency() == 1);
}

// Not less than was asked for, and not a crash of the driver's either.
TEST(Faults, TheLargestMapUnderALimitOfMemory) {
  if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer reserves more";
  const TemporaryFolder folder;
  expect_one_line(
      run_gnomon({"compare", "acne-floor", "-o", "out", "-q", "--size", "64x36", "--map-size", "16384"},
                 {.folder = folder.path(), .address_limit = 3000L << 20}),
      5, "not enough memory under the limit of this process");
  EXPECT_TRUE(folder.entries().empty());
}

// Whenever it comes, no half folder is seen, and the next run takes what was left out of the way.
TEST(Faults, KilledAtAnyMoment) {
  const TemporaryFolder folder;
  for (const int after_ms : {0, 40, 90, 150, 220, 300}) {
    const ProcessResult killed = run_gnomon(
        compare_into("out"), {.folder = folder.path(), .interrupt_after_ms = after_ms, .signal = SIGKILL});
    EXPECT_TRUE(killed.exit_code == 0 || killed.signal == SIGKILL) << killed.exit_code;
    if (fs::exists(folder / "out")) {
      EXPECT_TRUE(fs::exists(folder / "out/report.html") && fs::exists(folder / "out/result.json"));
      fs::remove_all(folder / "out");
    }
  }
  EXPECT_EQ(run_gnomon(compare_into("out"), {.folder = folder.path()}).exit_code, 0);
  expect_whole(folder, "out");
}

TEST(Faults, SigtermEndsAsSigintDoes) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_gnomon({"compare", "fence", "--size", "4096x4096", "--runs", "9"},
                 {.folder = folder.path(), .interrupt_after_ms = 100, .signal = SIGTERM});
  EXPECT_EQ(result.exit_code, 128 + SIGTERM);
  EXPECT_NE(result.err.find("interrupted"), std::string::npos);
  EXPECT_TRUE(folder.entries().empty());
}

// Two comparisons end with one of the two, whole; of two sweeps the later is refused.
TEST(Faults, TwoProcessesInOneFolder) {
  const TemporaryFolder folder;
  ProcessResult other;
  std::thread thread([&] { other = run_gnomon(compare_into("out"), {.folder = folder.path()}); });
  const ProcessResult one = run_gnomon(compare_into("out"), {.folder = folder.path()});
  thread.join();
  EXPECT_TRUE(one.exit_code == 0 && other.exit_code == 0) << one.err << other.err;
  expect_whole(folder, "out");
  const Words sweep{"sweep",  "acne-floor", "--bias", "0:0.1:400", "--size", "64x36",
                    "--runs", "1",          "-o",     "sweep",     "-q"};
  std::thread first([&] {
    other = run_gnomon(sweep, {.folder = folder.path(), .interrupt_after_ms = 1500, .signal = SIGINT});
  });
  while (!fs::exists(folder / "sweep/sweep.jsonl"))
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  expect_one_line(run_gnomon(sweep, {.folder = folder.path()}), 2,
                  "another process is at work in this folder");
  first.join();
  EXPECT_TRUE(other.exit_code == 130 || other.exit_code == 0) << other.err;
}

}  // namespace
}  // namespace gnomon::app_test
