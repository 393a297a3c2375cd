#include "tests/support/app_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/places.h"

namespace gnomon::app_test {

namespace {

namespace fs = std::filesystem;

/// Tests that are run in parts (gnomon_test PARTS) start programs of tests that are not.
struct WholePrograms : ::testing::Environment {
  void SetUp() override {
    unsetenv("GTEST_TOTAL_SHARDS");
    unsetenv("GTEST_SHARD_INDEX");
  }
};
const ::testing::Environment* const whole_programs = ::testing::AddGlobalTestEnvironment(new WholePrograms);

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) == 0) read_end = ends[0], write_end = ends[1];
  }
};

[[noreturn]] void become(const Words& arguments, const ProcessOptions& options, int out, int err) {
  if (!options.out_path.empty()) out = open(options.out_path.c_str(), O_WRONLY | O_CREAT, 0644);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  signal(SIGINT, SIG_DFL);  // a shell that runs the tests in the background has it ignored
  const rlimit limit{static_cast<rlim_t>(options.file_size_limit),
                     static_cast<rlim_t>(options.file_size_limit)};
  if (options.file_size_limit >= 0) setrlimit(RLIMIT_FSIZE, &limit);
  const rlimit addresses{static_cast<rlim_t>(options.address_limit),
                         static_cast<rlim_t>(options.address_limit)};
  if (options.address_limit >= 0) setrlimit(RLIMIT_AS, &addresses);
  for (const std::string& variable : options.environment) putenv(strdup(variable.c_str()));
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(99);
  std::string program = options.program.empty() ? gnomon::test::program() : options.program;
  std::vector<char*> words{program.data()};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const rlimit processes{static_cast<rlim_t>(options.process_limit),
                         static_cast<rlim_t>(options.process_limit)};
  constexpr uid_t nobody = 65534;
  if (options.process_limit >= 0 &&
      (setrlimit(RLIMIT_NPROC, &processes) != 0 || setresuid(nobody, nobody, nobody) != 0))
    _exit(97);
  if (options.prepare != nullptr) options.prepare();
  execv(program.c_str(), words.data());
  _exit(98);
}

/// Reads both streams until both are closed, so that neither can fill up.
void read_both(int out, int err, ProcessResult& result) {
  pollfd streams[2] = {{out, POLLIN, 0}, {err, POLLIN, 0}};
  std::string* texts[2] = {&result.out, &result.err};
  for (int open_streams = 2; open_streams > 0;) {
    if (poll(streams, 2, -1) < 0) continue;
    for (int k = 0; k < 2; ++k) {
      if (streams[k].fd < 0 || streams[k].revents == 0) continue;
      char buffer[65536];
      const ssize_t count = read(streams[k].fd, buffer, sizeof buffer);
      if (count > 0) {
        texts[k]->append(buffer, static_cast<std::size_t>(count));
      } else {
        close(streams[k].fd);
        streams[k].fd = -1;
        --open_streams;
      }
    }
  }
}

/// Linux: whether the process holds SIGINT back, as one does that waits for it in a thread of its own.
bool blocks_interrupts(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("SigBlk:"))
      return (std::stoull(line.substr(7), nullptr, 16) & (1u << (SIGINT - 1))) != 0;
  }
  return false;
}

/// A signal that comes before main would end the process without a word.
void interrupt_when_ready(pid_t process, int after_ms, int signal_number) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!blocks_interrupts(process) && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
  kill(process, signal_number);
}

void await_end(pid_t process, ProcessResult& result) {
  int status = 0;
  rusage used{};
  wait4(process, &status, 0, &used);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  result.cpu_ms = ms(used.ru_utime) + ms(used.ru_stime);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

ProcessResult run_gnomon(const Words& arguments, const ProcessOptions& options) {
  const Pipe out, err;
  const pid_t child = fork();
  if (child == 0) become(arguments, options, out.write_end, err.write_end);
  close(out.write_end);
  close(err.write_end);
  std::thread interrupter;
  if (options.interrupt_after_ms >= 0) {
    interrupter = std::thread(interrupt_when_ready, child, options.interrupt_after_ms, options.signal);
  }
  ProcessResult result;
  read_both(out.read_end, err.read_end, result);
  if (interrupter.joinable()) interrupter.join();
  await_end(child, result);
  return result;
}

void expect_one_line(const ProcessResult& result, int code, const std::string& part) {
  EXPECT_EQ(result.exit_code, code) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string policy_of(const std::string& page) {
  const std::string before = "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  const std::size_t at = page.find(before);
  if (at == std::string::npos || at > page.find("<style")) return {};
  return page.substr(at + before.size(), page.find('"', at + before.size()) - at - before.size());
}

}  // namespace gnomon::app_test
