// Runs a program as a person would, and keeps what it said. For the tests of the command line.
#pragma once

#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace gnomon::app_test {

using Words = std::vector<std::string>;

inline Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Options that make `compare` quick.
inline const Words small = {"--size", "64x36", "--map-size", "128", "--runs", "1"};

struct ProcessResult {
  int exit_code = -1;   ///< -1 when a signal ended it
  int signal = 0;       ///< that did
  double cpu_ms = 0.0;  ///< user and system time of all its threads, by the kernel's account
  std::string out, err;
};

struct ProcessOptions {
  std::string folder{};                    ///< working directory; empty: the test's own
  std::string program{};                   ///< empty: the program under test
  std::vector<std::string> environment{};  ///< "NAME=value", added to the test's own
  int interrupt_after_ms = -1;  ///< a signal is sent so long after the program waits for SIGINT; -1: never
  int signal = 2;               ///< which one: SIGINT
  std::string out_path{};       ///< stdout goes to this file instead
  int process_limit = -1;       ///< processes and threads, for a user who has no others; needs root; -1: any
  long address_limit = -1;      ///< bytes of address space; -1: any
  long file_size_limit = -1;    ///< bytes that a file may have; -1: any
  void (*prepare)() = nullptr;  ///< what else the child does to itself before it becomes the program
};

/// The program under test with these arguments.
ProcessResult run_gnomon(const Words& arguments, const ProcessOptions& options = {});

/// That exit code, nothing on stdout, and on stderr one line that holds the part.
void expect_one_line(const ProcessResult& result, int code, const std::string& part);

using test::TemporaryFolder;

inline std::string read_file(const std::string& path) {
  return test::bytes_of(path);
}
void write_text(const std::string& path, const std::string& text);
/// The content-security policy of a page; empty where it has none.
std::string policy_of(const std::string& page);

}  // namespace gnomon::app_test
