// Work beside its owner, one turn after another. It has a thread of its own. A program with one thread (a page) makes a turn each
// time that the thread calls take_turn().
#pragma once

#include <functional>
#include <memory>

namespace gnomon::lab {

class Turns {
 public:
  /// What is done before the first turn, at each, and after the last. `turn` returns false when it was the last; told to wait, it
  /// first waits until there is something to do.
  struct Work {
    std::function<void()> begin;
    std::function<bool(bool wait)> turn;
    std::function<void()> end;
  };
  explicit Turns(Work work);
  /// Returns after the last turn: the owner has made its work's next turn the last.
  ~Turns();
  Turns(const Turns&) = delete;
  Turns& operator=(const Turns&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Gives one of them its turn, each time the next. Does nothing where they have threads.
void take_turn();

}  // namespace gnomon::lab
