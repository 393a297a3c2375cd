// Times of repeated passes: every raw run is kept, the median is what is reported.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <limits>
#include <numeric>
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
  double most() const { return runs.empty() ? 0.0 : *std::max_element(runs.begin(), runs.end()); }
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

// How often a pass is timed, by one rule for both renderers, so that their times stand for the same care.

/// What both are timed by where nothing else is asked for: three runs, and no further one when those made took
/// this long together.
inline constexpr int usual_runs = 3;
inline constexpr double usual_enough_ms = 25.0;
inline constexpr double never_enough_ms = std::numeric_limits<double>::infinity();

/// How often a pass that is subtracted from another one, or another one from it, is run whatever its runs took. A
/// difference is known no better than its runs agree. Of fewer than three in one piece nobody can tell how well that is.
inline constexpr int subtracted_runs = 3;
/// As often are passes run that are cut into strips, if their difference is told then: each strip has a spread of its own.
inline constexpr int subtracted_runs_of_strips = 2;

/// Whether there is to be another run after those in `made`. There are `most` in all. Beyond the first `least` there
/// is another only as long as all took less than `enough_ms` together.
inline bool times_again(const Times& made, int most, double enough_ms, int least = 1) {
  const double spent = std::accumulate(made.runs.begin(), made.runs.end(), 0.0);
  const int count = static_cast<int>(made.runs.size());
  return count < most && (count < least || spent < enough_ms);
}

}  // namespace gnomon
