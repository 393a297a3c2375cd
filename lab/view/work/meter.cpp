#include "lab/view/work/meter.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/number_text.h"

namespace gnomon::lab {

namespace {

constexpr double goal_ms = 50.0;  // the window is never blocked for longer

}  // namespace

void Meter::Answer::arrived(double elapsed_ms) {
  if (waiting) ms.push_back(elapsed_ms);
  waiting = false;
}

std::string Meter::Answer::words(const char* what) const {
  if (ms.empty()) return {};
  std::vector<double> sorted = ms;
  std::sort(sorted.begin(), sorted.end());
  return fmt::format("; {} after {}, at most {} ({} times)", what,
                     compare::milliseconds(sorted[sorted.size() / 2]), compare::milliseconds(sorted.back()),
                     sorted.size());
}

void Meter::frame(const FrameWatch& watch) {
  ++frames_;
  if (watch.sum().wall_ms > goal_ms) ++long_frames_;
  if (watch.sum().wall_ms > longest_.sum().wall_ms) longest_ = watch;
}

void Meter::posted(std::uint64_t revision) {
  revision_ = revision;
  ++posts_;
  since_post_ = Stopwatch();
  picture_.waiting = preview_.waiting = full_.waiting = true;
}

void Meter::shown(const Snapshot& snapshot) {
  const double ms = since_post_.elapsed_ms();
  if (snapshot.live.revision == revision_) picture_.arrived(ms);
  if (!snapshot.outcome || snapshot.outcome->revision != revision_) return;
  preview_.arrived(ms);
  if (!snapshot.outcome->preview) full_.arrived(ms);
}

std::string Meter::words() const {
  return fmt::format("{} changes, {} frames, {} of them over {}, the longest {}: {}", posts_, frames_,
                     long_frames_, compare::milliseconds(goal_ms),
                     compare::milliseconds(longest_.sum().wall_ms), longest_.words()) +
         picture_.words("picture") + preview_.words("labels") + full_.words("labels in full");
}

}  // namespace gnomon::lab
