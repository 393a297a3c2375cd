#include "lab/view/window/frame_watch.h"

#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "compare/result/number_text.h"
#include "scene/base/stages.h"

namespace gnomon::lab {

namespace {

constexpr std::array<std::string_view, frame_part_count> names{"events", "snapshot", "pictures", "font",
                                                               "panels", "drawing",  "swap"};
constexpr double least_shown_ms = 1.0;

}  // namespace

FrameWatch::Time FrameWatch::now() {
  return {clock_ms(CLOCK_MONOTONIC), clock_ms(CLOCK_THREAD_CPUTIME_ID)};
}

void FrameWatch::end(FramePart part) {
  const Time before = std::exchange(mark_, now());
  Time& time = times_[static_cast<std::size_t>(part)];
  time.wall_ms += mark_.wall_ms - before.wall_ms;
  time.thread_ms += mark_.thread_ms - before.thread_ms;
}

FrameWatch::Time FrameWatch::sum() const {
  Time all;
  for (const Time& time : times_) all.wall_ms += time.wall_ms, all.thread_ms += time.thread_ms;
  return all;
}

std::string FrameWatch::words() const {
  std::array<std::size_t, frame_part_count> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [this](std::size_t a, std::size_t b) { return times_[a].wall_ms > times_[b].wall_ms; });
  std::string text;
  for (const std::size_t i : order) {
    if (times_[i].wall_ms < least_shown_ms) continue;
    text += fmt::format("{}{} {} ({})", text.empty() ? "" : ", ", names[i],
                        compare::milliseconds(times_[i].wall_ms), compare::milliseconds(times_[i].thread_ms));
  }
  return text;
}

}  // namespace gnomon::lab
