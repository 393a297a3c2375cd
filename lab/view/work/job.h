// A run of this program beside the window, by the words that a person would type: the tuner's search, a report.
// It can be stopped at any moment and ends with the window.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "scene/base/expected.h"
#include "scene/base/timing.h"

namespace gnomon::lab {

/// What a panel shows of it.
struct JobStatus {
  bool running = false;
  std::string title;  ///< "searching the best setting"
  double seconds = 0.0;
};

class Job {
 public:
  /// Error (resources): no process can be started.
  static Expected<std::unique_ptr<Job>> start(std::string title, const std::vector<std::string>& words);
  /// Stops it when it still runs.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Whether it has ended; then the three below are there.
  bool ended();
  int exit_code() const { return exit_code_; }  ///< 128 + the signal's number where one ended it
  std::string out() const;
  std::string err() const;
  JobStatus status() const { return {true, title_, watch_.elapsed_ms() / 1000.0}; }

 private:
  Job() = default;
  std::string title_;
  Stopwatch watch_;
  pid_t child_ = -1;  ///< -1: ended
  int exit_code_ = 0;
  int out_ = -1, err_ = -1;  ///< files in memory
};

}  // namespace gnomon::lab
