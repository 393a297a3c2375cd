// Programs that this one starts: their codes, that signals reach them though this one's threads block some, and what is out of
// reach of those that read a stranger's file.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "scene/base/confine.h"
#include "scene/base/run_apart.h"
#include "scene/base/run_program.h"
#include "tests/support/temporary_folder.h"

#include "scene/base/interruptible.h"

namespace gnomon {
namespace {

TEST(RunProgram, TellsHowItEnded) {
  EXPECT_EQ(run_program({"true"}).value(), 0);
  EXPECT_EQ(run_program({"sh", "-c", "exit 3"}).value(), 3);
  EXPECT_EQ(run_program({"sh", "-c", "kill -KILL $$"}).value(), 128 + SIGKILL);
  const auto none = run_program({"gnomon-no-such-program"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message(), "gnomon-no-such-program cannot be started: No such file or directory");
}

TEST(RunProgram, SignalsReachIt) {
  sigset_t terminate, before;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &terminate, &before);
  EXPECT_EQ(run_program({"sh", "-c", "kill -TERM $$; exit 0"}).value(), 128 + SIGTERM);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

/// Whether the process is there and no zombie, whom nobody may have taken yet.
bool runs(const std::string& pid) {
  std::ifstream status("/proc/" + pid + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("State:")) return line.find('Z') == std::string::npos;
  return false;
}

// With what it has started itself, though it will not end when it is asked to.
TEST(RunProgram, EndsWhatTakesTooLong) {
  const std::string note = testing::TempDir() + "/gnomon-run-program-" + std::to_string(getpid());
  const auto ended = run_program(
      {"sh", "-c", "trap '' TERM; sh -c 'echo $$; exec sleep 1000' >" + note + " & wait; sleep 1000"}, 0.5);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().kind, ErrorKind::graphics);
  EXPECT_EQ(ended.error().message(), "sh did not end within 0.5 s, and was ended");
  std::string child;
  std::getline(std::ifstream(note), child);
  EXPECT_FALSE(runs(child)) << child;
  std::filesystem::remove(note);
}

TEST(RunProgram, EndsWhatIsWaitedForInVain) {
  const std::string note = testing::TempDir() + "/gnomon-run-program-" + std::to_string(getpid());
  const Interruptible work([&] { return std::filesystem::exists(note); });
  const auto ended =
      run_program({"sh", "-c", "echo $$ >" + note + ".part; mv " + note + ".part " + note + "; sleep 1000"});
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().message(), "sh was ended");
  std::filesystem::remove(note);
}

/// Whether a program that ignores signals is gone once end_programs() has returned, and none is started after it.
bool no_program_outlives_the_end() {
  const std::string note = testing::TempDir() + "/gnomon-run-program-" + std::to_string(getpid());
  std::thread waits([&] {
    run_program({"sh", "-c",
                 "trap '' TERM; echo $$ >" + note + ".part; mv " + note + ".part " + note +
                     "; sleep 1000; sleep 1000"});
  });
  while (!std::filesystem::exists(note)) std::this_thread::yield();
  end_programs();
  std::string child;
  std::getline(std::ifstream(note), child);
  const bool ended = !runs(child), none = !run_program({"true"});
  waits.join();
  std::filesystem::remove(note);
  return ended && none;
}

// In a process of its own, which it leaves without programs for good.
TEST(RunProgram, EndsWhenTheProcessEnds) {
  EXPECT_EXIT(exit(no_program_outlives_the_end() ? 7 : 0), testing::ExitedWithCode(7), "");
}

/// What a shell of its own says, apart, of one file that it sees ($1) and one that it writes ($2).
Expected<ApartEnd> shell_apart(const std::string& commands, std::string_view bytes = "what it reads\n") {
  return run_apart({.name = "model.x3d",
                    .bytes = bytes,
                    .words =
                        [&](const std::string& in, const std::string& out) {
                          return std::vector<std::string>{"sh", "-c", commands, "sh", in, out};
                        },
                    .programs = {"sh"},
                    .longest_s = 60.0});
}

bool files_can_be_given_up() {
  bool can = false;
  std::thread([&] { can = give_up_rights({}); }).join();
  return can;
}

TEST(RunApart, ReadsOneFileAndWritesOne) {
  const auto end = shell_apart("cat \"$1\" >\"$2\"; cat \"$1\" >>\"$2\"; echo \"said of $1\"; exit 3");
  ASSERT_TRUE(end) << end.error().message();
  EXPECT_EQ(end->code, 3);
  EXPECT_EQ(end->written, "what it reads\nwhat it reads\n");
  EXPECT_EQ(end->said, "said of model.x3d\n");
  const std::string large(std::size_t{3} << 20, 'x');
  const auto copied = shell_apart("cat \"$1\" >\"$2\"", large);
  ASSERT_TRUE(copied) << copied.error().message();
  EXPECT_EQ(copied->written, large);
}

TEST(RunApart, LeavesNoFolder) {
  const auto end = shell_apart("dirname \"$1\" >\"$2\"");
  ASSERT_TRUE(end) << end.error().message();
  const std::string folder = end->written.substr(0, end->written.find('\n'));
  EXPECT_NE(folder, "");
  EXPECT_FALSE(std::filesystem::exists(folder)) << folder;
}

// Where the kernel can take it away: by its path, beside the file, through /proc, a pipe that would hold it, a listed folder.
TEST(RunApart, SeesNoOtherFile) {
  if (!files_can_be_given_up()) GTEST_SKIP() << "this kernel has no Landlock";
  const test::TemporaryFolder folder;
  const std::string secret = folder.put("secret.txt", "the secret");
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  for (const std::string& command : std::vector<std::string>{
           "cat " + secret, "cd " + folder.path() + " && cat secret.txt",
           "cat /proc/" + std::to_string(getpid()) + "/cmdline",
           "cat /proc/" + std::to_string(getpid()) + "/root" + secret, "cat " + folder.file("pipe"),
           "ls " + folder.path(), "cat /etc/passwd", "ln -s " + secret + " \"$(dirname \"$1\")/beside\""}) {
    const auto end = shell_apart("if " + command + " >\"$2\"; then echo could; fi");
    ASSERT_TRUE(end) << command << ": " << end.error().message();
    EXPECT_EQ(end->said.find("could\n"), std::string::npos) << command << ": " << end->said;
    EXPECT_EQ(end->written, "") << command;
  }
}

TEST(RunApart, ChangesNothing) {
  if (!files_can_be_given_up()) GTEST_SKIP() << "this kernel has no Landlock";
  const test::TemporaryFolder folder;
  const std::string mine = folder.put("mine.txt", "mine");
  for (const std::string& command :
       std::vector<std::string>{"echo x >" + mine, "echo x >" + folder.file("new.txt"), "rm " + mine,
                                "mv " + mine + " " + folder.file("moved"), "mkdir " + folder.file("new"),
                                "kill -0 " + std::to_string(getpid())}) {
    const auto end = shell_apart("if (" + command + "); then echo could; fi");
    ASSERT_TRUE(end) << command << ": " << end.error().message();
    EXPECT_EQ(end->said.find("could\n"), std::string::npos) << command << ": " << end->said;
  }
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"mine.txt"});
  EXPECT_EQ(test::bytes_of(mine), "mine");
}

TEST(RunApart, HasNoNetwork) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET, here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof here;
  ASSERT_EQ(bind(server, reinterpret_cast<sockaddr*>(&here), size), 0);
  ASSERT_EQ(listen(server, 4), 0);
  ASSERT_EQ(getsockname(server, reinterpret_cast<sockaddr*>(&here), &size), 0);
  const std::string port = std::to_string(ntohs(here.sin_port));
  for (const char* kind : {"tcp", "udp"}) {
    const auto end =
        shell_apart(std::string("bash -c 'exec 3<>/dev/") + kind + "/127.0.0.1/" + port + "' && echo could");
    ASSERT_TRUE(end) << end.error().message();
    EXPECT_EQ(end->said.find("could\n"), std::string::npos) << kind << ": " << end->said;
  }
  close(server);
}

}  // namespace
}  // namespace gnomon
