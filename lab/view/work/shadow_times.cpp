#include "lab/view/work/shadow_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace gnomon::lab {

namespace {

constexpr std::size_t wanted_runs = 5;
/// Of one run, all its drawings together: browsers count in steps of 0.1 ms and more, and a page's frame is to wait no longer.
constexpr double run_ms = 30.0;
constexpr double most_drawings = 100.0;

}  // namespace

void ShadowTimer::begin(std::uint64_t revision) {
  if (now_.revision == revision) return;
  now_ = {}, now_.revision = revision, asked_ = false, step_us_ = 0;
}

void ShadowTimer::take_run(std::uint64_t revision, const raster::LightRecord& drawn) {
  if (knows(revision)) return;
  begin(revision);
  now_.map.runs.insert(now_.map.runs.end(), drawn.map_pass.runs.begin(), drawn.map_pass.runs.end());
  now_.strips.resize(drawn.strips.size());
  for (std::size_t i = 0; i < drawn.strips.size(); ++i) {
    now_.strips[i].whole.runs.push_back(drawn.strips[i].whole.runs.front());
    now_.strips[i].part.runs.push_back(drawn.strips[i].part.runs.front());
  }
  if (now_.map.runs.size() == subtracted_runs) known_ = std::make_shared<const ShadowTimes>(now_);
}

Expected<void> ShadowTimer::take_turn(std::uint64_t revision, raster::Renderer& renderer, const Draw& draw) {
  if (knows(revision)) return {};
  begin(revision);
  if (asked_) {
    const std::optional<raster::ShadowSpans> spans = renderer.take_spans();
    if (!spans) return {};
    asked_ = false;
    take(*spans);
    if (knows(revision)) return {};
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
  now_.strips.resize(1);
  now_.strips.front().whole.runs.push_back(spans.shaded_ms / now_.drawings);
  now_.strips.front().part.runs.push_back(spans.unshadowed_ms / now_.drawings);
  if (now_.map.runs.size() == wanted_runs) known_ = std::make_shared<const ShadowTimes>(now_);
}

}  // namespace gnomon::lab
