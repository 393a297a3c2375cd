// Two passes timed in turn, so that what else the machine does meets both.
#pragma once

#include <utility>

#include "cpu_time.h"
#include "scene/base/timing.h"

namespace gnomon::bench {

/// The calling thread's processor time where it runs alone, else the clock's.
template <class Pass>
void time_pass(Times& times, int threads, const Pass& pass) {
  const Stopwatch watch;
  const double start = thread_ms();
  pass();
  times.runs.push_back(threads == 1 ? thread_ms() - start : watch.elapsed_ms());
}

/// Runs both in turn, `runs` times after a warm-up, and gives the median milliseconds of each.
template <class Ours, class Theirs>
std::pair<double, double> in_turn(int runs, int threads, const Ours& ours, const Theirs& theirs) {
  Times a, b;
  ours(), theirs();
  for (int i = 0; i < runs; ++i) time_pass(a, threads, ours), time_pass(b, threads, theirs);
  return {a.median(), b.median()};
}

}  // namespace gnomon::bench
