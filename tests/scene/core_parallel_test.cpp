// Loops over all threads (scene/base/parallel.h).
#include "scene/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "scene/base/interruptible.h"

namespace {

using namespace gnomon;

TEST(ParallelFor, ReachesEveryIndexOnce) {
  for (const std::uint32_t count : {0u, 1u, 2u, 1000u, 100'003u}) {
    std::vector<std::atomic<int>> times(count);
    parallel_for(count, [&](std::uint32_t i) { ++times[i]; });
    EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](const auto& n) { return n == 1; })) << count;
  }
}

TEST(ParallelFor, OfANegativeCountDoesNothing) {
  bool called = false;
  parallel_for(-3, [&](int) { called = true; });
  EXPECT_FALSE(called);
}

TEST(ParallelRanges, CoverAllAndAreLongEnough) {
  constexpr std::size_t count = 10'000, at_a_time = 64;
  std::vector<std::atomic<int>> times(count);
  std::atomic<std::size_t> shortest{count};
  parallel_ranges(count, at_a_time, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) ++times[i];
    for (std::size_t least = shortest;
         last - first < least && !shortest.compare_exchange_weak(least, last - first);) {
    }
  });
  EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](const auto& n) { return n == 1; }));
  EXPECT_GE(shortest, at_a_time / 2);
}

TEST(ParallelTasks, OneCallForEach) {
  std::vector<std::atomic<int>> times(37);
  parallel_tasks(times.size(), [&](std::size_t i) { ++times[i]; });
  EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](const auto& n) { return n == 1; }));
}

TEST(ParallelInvoke, DoesBoth) {
  int first = 0, second = 0;
  parallel_invoke([&] { first = 1; }, [&] { second = 2; });
  EXPECT_EQ(first + second, 3);
}

// Of texts joining is not commutative, and shows how the ranges were cut and joined.
std::string cuts(std::size_t count, std::size_t at_a_time) {
  return parallel_reduce(
      count, at_a_time, std::string("0"),
      [](std::size_t first, std::size_t last, const std::string& none) {
        return none + "+" + std::to_string(first) + "-" + std::to_string(last);
      },
      [](const std::string& left, const std::string& right) { return "(" + left + " " + right + ")"; });
}

TEST(ParallelReduce, HalvesUntilShortEnoughAndJoinsNeighboursInOrder) {
  EXPECT_EQ(cuts(0, 4), "0+0-0");
  EXPECT_EQ(cuts(4, 4), "0+0-4");
  EXPECT_EQ(cuts(9, 4), "(0+0-4 (0+4-6 0+6-9))");
  EXPECT_EQ(cuts(11, 4), "((0+0-2 0+2-5) (0+5-8 0+8-11))");
}

TEST(ParallelReduce, SumsOfTruthsDoNotShareAByte) {  // as the elements of std::vector<bool> would
  for (int repeat = 0; repeat < 20; ++repeat)
    EXPECT_FALSE(parallel_reduce(
        100'000, 1, true,
        [](std::size_t first, std::size_t, bool so_far) { return so_far && first != 77'777; },
        [](bool a, bool b) { return a && b; }));
}

TEST(PerThread, EachThreadHasOneOfItsOwn) {
  PerThread<std::set<std::thread::id>> seen;
  std::atomic<int> calls{0};
  parallel_tasks(1000, [&](std::size_t) {
    seen.local().insert(std::this_thread::get_id());
    ++calls;
  });
  EXPECT_EQ(calls, 1000);
  std::set<std::thread::id> all;
  for (const auto& of_one : seen) {
    EXPECT_EQ(of_one.size(), 1u);
    all.insert(of_one.begin(), of_one.end());
  }
  EXPECT_EQ(all.size(), static_cast<std::size_t>(std::distance(seen.begin(), seen.end())));
}

TEST(PerThread, ValuesAreMadeByTheGivenFunction) {
  PerThread<int> sums([] { return 100; });
  std::thread([&] { ++sums.local(); }).join();
  ++sums.local();
  EXPECT_EQ(std::accumulate(sums.begin(), sums.end(), 0), 202);
}

TEST(Parallel, AnExceptionEndsTheLoopAndItsOtherTasksAreTold) {
  EXPECT_FALSE(is_given_up());
  const auto work = [&] {
    parallel_tasks(2, [&](std::size_t i) {
      if (i == 0) throw std::runtime_error("no more");
      while (!is_given_up()) std::this_thread::yield();
    });
  };
  if (threads_in_use() < 2) GTEST_SKIP() << "one thread: the tasks run one after the other";
  EXPECT_THROW(work(), std::runtime_error);
  EXPECT_FALSE(is_given_up());
}

// As they are left by any exception; what another thread does, and what is begun afterwards, is not.
TEST(Interruptible, LeavesLoopsWithinLoopsOnAllThreads) {
  constexpr int most = 1'000'000;
  std::atomic<int> begun{0}, others{0};
  const auto count_to = [](int count, std::atomic<int>& counter) {
    parallel_for(count, 1, [&](int) { ++counter; });
  };
  {
    const Interruptible work([&] { return begun >= 1000; });
    EXPECT_THROW(parallel_tasks(64, [&](std::size_t) { count_to(most, begun); }), Interrupted);
    EXPECT_LT(begun, 64 * most);
    EXPECT_TRUE(is_interrupted());
    std::thread([&] { count_to(most, others); }).join();
    EXPECT_EQ(others, most);
    const Interruptible inner([] { return false; });
    EXPECT_FALSE(is_interrupted()) << "the innermost counts";
  }
  EXPECT_EQ(interruptible_work(), nullptr);
  others = 0;
  count_to(most, others);
  EXPECT_EQ(others, most);
}

TEST(RunIsolated, TakesUpNothingBegunOutside) {
  std::atomic<int> inside{0};
  std::atomic<bool> mixed{false};
  thread_local bool in_isolation = false;
  parallel_tasks(64, [&](std::size_t) {
    if (in_isolation) mixed = true;  // an outer task, taken up while this thread waits for an inner loop
    in_isolation = true;
    run_isolated([&] { parallel_tasks(64, [&](std::size_t) { ++inside; }); });
    in_isolation = false;
  });
  EXPECT_EQ(inside, 64 * 64);
  EXPECT_FALSE(mixed);
}

TEST(Threads, AreCounted) {
  EXPECT_GE(threads_in_use(), 1);
  EXPECT_GE(threads_for_loops(), 1);
}

}  // namespace
