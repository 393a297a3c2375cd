// What benchmarks share: CPU time, which other programs on the machine disturb little; two passes timed in turn, so that what
// else the machine does meets both; and the end for an error that nobody can be handed.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <utility>

#include "benchmark/row.h"
#include "scene/base/expected.h"
#include "scene/base/stages.h"
#include "scene/base/timing.h"

namespace gnomon::bench {

/// Milliseconds of the process's own, all threads.
inline double cpu_ms() {
  return clock_ms(CLOCK_PROCESS_CPUTIME_ID);
}
/// Returns the calling thread's own time: for work on one thread the wall clock's, but for other programs' share, and
/// without what idle workers of earlier work take before they sleep.
inline double thread_ms() {
  return clock_ms(CLOCK_THREAD_CPUTIME_ID);
}

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

/// Prints a row that has a peer, for people.
inline void show(std::FILE* table, const BenchRow& row) {
  const double ratio = row.ratio().value();
  fmt::print(table, "  {:<32} {} thr {:>9.2f} {:<8} {:<26} {:>9.2f}  x{:.2f}{}\n", row.name, row.threads,
             row.value, row.unit, row.peer->name, row.peer->value, ratio,
             row.goal ? fmt::format("  goal {:.2f} {}", *row.goal, *row.met() ? "met" : "NOT MET") : "");
  std::fflush(table);
}

/// The value, or the error as the program's last word.
template <class T>
T must(Expected<T> value) {
  if (!value) {
    fmt::print(stderr, "{}\n", value.error().message());
    std::exit(1);
  }
  if constexpr (!std::is_void_v<T>) return std::move(*value);
}

}  // namespace gnomon::bench
