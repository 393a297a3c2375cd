// Turns of lab/view/work/turns.h, and who gives way to whom, on the one thread that there is.
#include "lab/view/work/turns.h"

#include <utility>
#include <vector>

#include "lab/view/work/priority.h"

namespace gnomon::lab {

namespace {

/// Of all that there are, in the order in which they came.
std::vector<std::function<void()>*> turns;

}  // namespace

struct Turns::Impl {
  explicit Impl(Work of) : work(std::move(of)) { turns.push_back(&take); }
  ~Impl() {
    std::erase(turns, &take);
    if (begun) work.end();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  void take_one() {
    if (!std::exchange(begun, true)) work.begin();
    work.turn(false);
  }
  Work work;
  bool begun = false;
  std::function<void()> take = [this] { take_one(); };
};

Turns::Turns(Work work) : impl_(std::make_unique<Impl>(std::move(work))) {}
Turns::~Turns() = default;

void take_turn() {
  static std::size_t next = 0;
  if (!turns.empty()) (*turns[next++ % turns.size()])();
}

void give_way(int) {}

struct HelpersGiveWay::Observer {};
HelpersGiveWay::HelpersGiveWay(int) {}
HelpersGiveWay::~HelpersGiveWay() = default;

}  // namespace gnomon::lab
