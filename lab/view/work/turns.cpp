#include "lab/view/work/turns.h"

#include <thread>

namespace gnomon::lab {

struct Turns::Impl {
  explicit Impl(Work of) : work(std::move(of)), thread([this] { run(); }) {}
  void run() const {
    work.begin();
    while (work.turn(true)) {
    }
    work.end();
  }
  Work work;
  std::thread thread;  ///< last
};

Turns::Turns(Work work) : impl_(std::make_unique<Impl>(std::move(work))) {}

Turns::~Turns() {
  impl_->thread.join();
}

void take_turn() {}

}  // namespace gnomon::lab
