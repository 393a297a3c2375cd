// Loops over all threads. oneTBB does the work, in parallel.cpp alone: its headers take seconds to compile in every file
// that includes them, and a loop written with them as long again. A page has one thread
// (platform/web/one_thread.cpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <forward_list>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace gnomon {

// Somebody else's callable behind two pointers: what is called through it is compiled once, not once per callable.

template <class Signature>
class FunctionRef;

/// Refers to the callable, which must outlive it.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Callable>
  FunctionRef(const Callable& callable)
      : callable_(std::addressof(callable)), call_([](const void* self, Arguments... arguments) -> Result {
          return (*static_cast<const Callable*>(self))(std::forward<Arguments>(arguments)...);
        }) {}
  Result operator()(Arguments... arguments) const {
    return call_(callable_, std::forward<Arguments>(arguments)...);
  }

 private:
  const void* callable_;
  Result (*call_)(const void* self, Arguments... arguments);
};

/// Calls body(first, last) for ranges that together are [0, count), each on one thread. A range is at least half of
/// `at_a_time` long unless `count` is less; the busier the threads are, the longer ranges get.
void parallel_ranges(std::size_t count, std::size_t at_a_time,
                     FunctionRef<void(std::size_t first, std::size_t last)> body);

/// task(i) for 0 ... count - 1, each free for another thread to take: for few and long ones.
void parallel_tasks(std::size_t count, FunctionRef<void(std::size_t)> task);

/// body(i) for 0 ... count - 1, i of `count`'s type, in ranges as above.
template <class Index, class Body>
void parallel_for(Index count, std::size_t at_a_time, const Body& body) {
  if (!(Index{0} < count)) return;
  parallel_ranges(static_cast<std::size_t>(count), at_a_time, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) body(static_cast<Index>(i));
  });
}
template <class Index, class Body>
void parallel_for(Index count, const Body& body) {
  parallel_for(count, 1, body);
}

namespace parallel_detail {

/// So that neighbouring sums are objects of their own: the elements of a std::vector<bool> share bytes.
template <class Sum>
struct Slot {
  Sum sum;
};

/// [first, last) in halves until none is longer than `at_a_time`; each(first, last) in their order.
template <class Each>
void halve(std::size_t first, std::size_t last, std::size_t at_a_time, const Each& each) {
  if (last - first <= at_a_time) return each(first, last);
  const std::size_t middle = first + (last - first) / 2;
  halve(first, middle, at_a_time, each);
  halve(middle, last, at_a_time, each);
}

template <class Sum, class Join>
Sum join_halves(std::size_t count, std::size_t at_a_time, Slot<Sum>*& next, const Join& join) {
  if (count <= at_a_time) return std::move((next++)->sum);
  Sum left = join_halves(count / 2, at_a_time, next, join);
  const Sum right = join_halves(count - count / 2, at_a_time, next, join);
  return join(std::move(left), right);
}

}  // namespace parallel_detail

/// [0, count) is halved until no range is longer than `at_a_time`. Of each, add(first, last, none) is a sum; of neighbours
/// join(left, right). The same for any number of threads.
template <class Sum, class Add, class Join>
Sum parallel_reduce(std::size_t count, std::size_t at_a_time, const Sum& none, const Add& add,
                    const Join& join) {
  std::vector<std::size_t> ends{0};
  parallel_detail::halve(0, count, at_a_time, [&](std::size_t, std::size_t last) { ends.push_back(last); });
  std::vector<parallel_detail::Slot<Sum>> sums(ends.size() - 1, {none});
  parallel_for(sums.size(),
               [&](std::size_t i) { sums[i].sum = add(ends[i], ends[i + 1], std::move(sums[i].sum)); });
  auto* next = sums.data();
  return parallel_detail::join_halves(count, at_a_time, next, join);
}

/// Per thread a pointer that is made when the thread first asks.
class ThreadSlots {
 public:
  ThreadSlots();
  ~ThreadSlots();
  /// Threads call `make` one at a time.
  void* local(FunctionRef<void*()> make);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A value for each thread that asks for one; begin() to end() are all of them, once no thread asks any more.
template <class Value>
class PerThread {
 public:
  explicit PerThread(std::function<Value()> make = [] { return Value(); }) : make_(std::move(make)) {}
  Value& local() {
    const auto add = [this]() -> void* { return &values_.emplace_front(make_()); };
    return *static_cast<Value*>(slots_.local(add));
  }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }

 private:
  std::function<Value()> make_;
  std::forward_list<Value> values_;
  ThreadSlots slots_;
};

/// Both, at the same time where another thread is free.
template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
  parallel_tasks(2, [&](std::size_t i) { i == 0 ? first() : second(); });
}

/// work(), during which this thread takes up nothing that was begun outside it. A loop waits for its last ranges by
/// working on what else there is, which may then be work that waits for this thread.
void run_isolated(FunctionRef<void()> work);

/// Whether the loop around this one is given up because an exception ended one of its threads: then this one was skipped, in
/// part or whole.
bool is_given_up();

/// Threads that a loop begun now may have.
int threads_for_loops();
/// Returns the threads of the whole program, as --threads limits them.
int threads_in_use();
/// Loops have at most so many threads from here on; the first call holds.
void limit_loops(int threads);

/// As std::sort(), in halves on all threads, whose sorted halves are merged.
template <class Value, class Less>
void parallel_sort(std::span<Value> values, const Less& less) {
  constexpr std::size_t at_a_time = 16384;
  if (values.size() <= at_a_time) return std::sort(values.begin(), values.end(), less);
  const std::size_t half = values.size() / 2;
  parallel_invoke([&] { parallel_sort(values.first(half), less); },
                  [&] { parallel_sort(values.subspan(half), less); });
  std::inplace_merge(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half), values.end(), less);
}

// Long lists of plain numbers in ascending order, by Highway's vectorised quicksort (Blacher, Giesen, Kühne 2022,
// "Vectorized and performance-portable Quicksort"): one thread is there before two are with std::sort. Floats are sorted
// as whole numbers of 64 bits. As they are, Highway 1.0.3 fails on infinities, and of 32 bits it takes eight times as
// long on a Zen 4, whose compressing stores are slow; vectors of 64 bits it divides by permutations.

/// Ascending; NaNs, in any order, behind all numbers.
void sort_numbers(std::span<float> values);
void sort_numbers(std::span<std::uint64_t> values);

// The first of many things that is so, looked for on every thread.

/// The least i below `count` for which is(i); `count` where there is none.
template <class Is>
std::size_t first_where(std::size_t count, const Is& is) {
  constexpr std::size_t at_a_time = 8192;
  return parallel_reduce(
      count, at_a_time, count,
      [&](std::size_t first, std::size_t last, std::size_t none) {
        for (std::size_t i = first; i < last; ++i)
          if (is(i)) return i;
        return none;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

// An error that ends one thread of a parallel loop makes the loop give up. A parallel loop inside it is then
// skipped, in part or whole. What that was to make is not there. Who needs it asks here first.

/// Never seen outside: the outer loop already has the error that ends it.
struct GivenUp : std::exception {
  const char* what() const noexcept override { return "part of a work that an error ended"; }
};

/// After a parallel loop that may lie inside another one. Throws GivenUp when the work around it was given up.
inline void leave_if_given_up() {
  if (is_given_up()) throw GivenUp();
}

}  // namespace gnomon
