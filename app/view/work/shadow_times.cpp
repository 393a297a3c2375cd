#include "app/view/work/shadow_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace gnomon::app {

namespace {

constexpr std::size_t wanted_runs = 5;
/// Of one run, all its drawings together: browsers count in steps of 0.1 ms and more, and a page's frame is to wait no longer.
constexpr double run_ms = 30.0;
constexpr double most_drawings = 100.0;

}  // namespace

TimeDifference ShadowTimes::map_and_lookups() const {
  TimeDifference both = lookups();
  both += map.median();
  return both;
}

Expected<void> ShadowTimer::take_turn(std::uint64_t revision, raster::Renderer& renderer, const Draw& draw) {
  if (known_ && known_->revision == revision) return {};
  if (now_.revision != revision) now_ = {}, now_.revision = revision, asked_ = false, step_us_ = 0;
  if (asked_) {
    const std::optional<raster::ShadowSpans> spans = renderer.take_spans();
    if (!spans) return {};
    asked_ = false;
    take(*spans);
    if (known_ && known_->revision == revision) return {};
  }
  asked_ = true;
  return draw(std::max(1, now_.drawings));
}

/// The first run tells how many drawings a run is to have, and counts no further: the driver may have made its programs in it.
void ShadowTimer::take(const raster::ShadowSpans& spans) {
  if (!spans.counted) return;
  const std::array all{spans.map_ms, spans.shaded_ms, spans.unshadowed_ms};
  if (now_.drawings == 0) {
    const double once_ms = std::max(1e-3, std::accumulate(all.begin(), all.end(), 0.0));
    now_.drawings = static_cast<int>(std::clamp(run_ms / once_ms, 1.0, most_drawings));
    return;
  }
  for (const double ms : all) step_us_ = std::gcd(step_us_, std::llround(1e3 * ms));
  now_.by_device = spans.by_device;
  now_.step_ms = 1e-3 * static_cast<double>(step_us_);
  now_.map.runs.push_back(spans.map_ms / now_.drawings);
  now_.shaded.runs.push_back(spans.shaded_ms / now_.drawings);
  now_.unshadowed.runs.push_back(spans.unshadowed_ms / now_.drawings);
  if (now_.map.runs.size() == wanted_runs) known_ = std::make_shared<const ShadowTimes>(now_);
}

}  // namespace gnomon::app
