// The program as a process, in a folder of its own: what tests of sweep and tune start, interrupt and read.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::test {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Starts the program; stdout and stderr go to `log`.
inline pid_t start(const Words& words, const std::string& log) {
  Words all{program()};
  all.insert(all.end(), words.begin(), words.end());
  const pid_t child = fork();
  if (child != 0) return child;
  std::freopen(log.c_str(), "w", stdout);
  std::freopen(log.c_str(), "a", stdout);  // behind what stderr has said by then
  std::freopen(log.c_str(), "a", stderr);
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  _exit(127);
}

/// The exit code, or 128 + signal.
inline int finish(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class SweepProgram : public ::testing::Test {
 protected:
  // Three drawings with four biases each.
  Words words(const std::string& folder, const Words& more = {}) const {
    Words all{"sweep",  "floating-box", "--size",    "96x54", "--map-size", "32,64,128",
              "--bias", "0:0.1:4",      "--threads", "2",     "-o",         (root / folder).string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  int run(const Words& words) const { return finish(start(words, log())); }
  std::string log() const { return (root / "log").string(); }
  std::string said() const { return bytes_of(log()); }
  std::string lines(const std::string& folder) const { return bytes_of(root / folder / "sweep.jsonl"); }

  void expect_same(const std::string& a, const std::string& b) const {
    EXPECT_TRUE(lines(a) == lines(b)) << a << " and " << b << " differ in sweep.jsonl";
    EXPECT_EQ(untimed_table(a), untimed_table(b)) << a << " and " << b << " differ in sweep.csv";
  }

  // sweep.csv without what depends on the machine and on where the sweep was interrupted. No field of these
  // sweeps is quoted.
  std::string untimed_table(const std::string& folder) const {
    std::istringstream table(bytes_of(root / folder / "sweep.csv"));
    std::vector<bool> kept;
    std::string out;
    for (std::string line; std::getline(table, line);) {
      std::istringstream fields(line);
      std::size_t column = 0;
      for (std::string field; std::getline(fields, field, ','); ++column) {
        if (column >= kept.size())
          kept.push_back(!field.starts_with("times_ms_") && field != "cell_ms" && field != "derived" &&
                         field != "load");
        if (kept[column]) out += field + ',';
      }
      out += '\n';
    }
    return out;
  }

  const TemporaryFolder folder_;
  const fs::path root{folder_.path()};
};

}  // namespace gnomon::test
