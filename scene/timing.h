// Times of repeated passes: every raw run is kept, the median is what is reported.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <vector>

namespace gnomon {

/// Milliseconds of each run, in the order they were made (warm-up runs are not kept).
struct Times {
  std::vector<double> runs;
  double median() const {
    if (runs.empty()) return 0.0;
    std::vector<double> sorted = runs;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t n = sorted.size();
    return n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
  }
  /// What else the machine does can only add: the least holds the least of it. 0 when there are no runs.
  double least() const { return runs.empty() ? 0.0 : *std::min_element(runs.begin(), runs.end()); }
  /// Adds the times of a further part of the work (a band of the picture), run by run. A pass that some part ran less
  /// often counts as often as there.
  void add_part(const Times& part) {
    if (runs.empty()) {
      runs = part.runs;
      return;
    }
    runs.resize(std::min(runs.size(), part.runs.size()));
    for (std::size_t i = 0; i < runs.size(); ++i) runs[i] += part.runs[i];
  }
};

/// Milliseconds since construction.
class Stopwatch {
 public:
  double elapsed_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Milliseconds of processor time of all of this process's threads since construction: what else the machine does is no
/// part of it.
class ProcessorStopwatch {
 public:
  double elapsed_ms() const { return now_ms() - start_; }

 private:
  static double now_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }
  double start_ = now_ms();
};

/// Runs `pass` once and appends its time.
template <class Pass>
void time_run(Times& times, const Pass& pass) {
  const Stopwatch watch;
  pass();
  times.runs.push_back(watch.elapsed_ms());
}

}  // namespace gnomon
