// Who goes first where there are fewer cores than threads: the window, then the pictures that are drawn, then what is
// compared.
#pragma once

#include <memory>

namespace gnomon::lab {

/// What the calling thread gives way to: all that has less (Linux: its nice value; it cannot be taken back).
inline constexpr int drawing_gives_way = 5, comparing_gives_way = 10;
void give_way(int nice);

/// While it lives oneTBB's workers that help the calling thread give way as much as it does.
class HelpersGiveWay {
 public:
  explicit HelpersGiveWay(int nice);
  ~HelpersGiveWay();
  HelpersGiveWay(const HelpersGiveWay&) = delete;
  HelpersGiveWay& operator=(const HelpersGiveWay&) = delete;

 private:
  struct Observer;
  std::unique_ptr<Observer> observer_;
};

}  // namespace gnomon::lab
