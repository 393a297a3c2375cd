#include "compare/advice/tried.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "compare/advice/candidates.h"
#include "compare/measure/measure.h"
#include "compare/result/figures.h"
#include "compare/truth/theory.h"
#include "scene/base/stages.h"

namespace gnomon::compare {
namespace {

constexpr double clear_gain_of_size = 0.2;

TriedKind kind_of(const TriedSetting& tried, const raster::MapOptions& drawn) {
  raster::MapOptions same_size = tried.map;
  same_size.size = drawn.size;
  if (same_size != drawn) return TriedKind::other;
  return tried.map.size > drawn.size ? TriedKind::larger_map : TriedKind::smaller_map;
}

/// The median side of a texel on what is compared, in pixels.
double texel_pixels(const LadderInput& in, const Image<Label>& labels) {
  const PictureRows all{0, labels.size.height};
  std::vector<double> sides = std::move(theory_values(in, labels, all, all.count)[3]);
  std::erase_if(sides, [](double side) { return !std::isfinite(side); });
  return distribution(sides).median;
}

bool is_fine(const LightFigures& light) {
  return light.pixels.compared == 0 || has_fine_edges(light);
}

class Trials {
 public:
  Trials(Comparison& c, const Plan& plan, const Redraw& redraw) : c_(c), plan_(plan), redraw_(redraw) {}

  bool may_go_on() const { return !failed_ && drawings_ < most_tried; }
  /// Nothing where it could not be drawn.
  std::optional<TriedSetting> draw(const raster::MapOptions& map);
  void draw_smaller();

 private:
  /// What is known of the drawn size halved so many times: whether its edges are fine, and how often it would be halved itself.
  struct Halved {
    bool fine = false;
    int more = 0;
    std::optional<TriedSetting> tried{};
  };
  Halved halve(int times);

  Comparison& c_;
  const Plan& plan_;
  const Redraw& redraw_;
  std::size_t drawings_ = 0;
  bool failed_ = false;
  double texel_pixels_ = 0.0;  ///< of the last drawing, the widest of its lights
};

std::optional<TriedSetting> Trials::draw(const raster::MapOptions& map) {
  ++drawings_;
  const auto frame = redraw_(map);
  failed_ = !frame || frame->lights.size() != c_.raster.lights.size();
  if (failed_) return std::nullopt;
  TriedSetting tried{map, {}};
  texel_pixels_ = 0.0;
  for (const LightComparison& light : c_.lights) {
    const LadderInput in{plan_.tracer, *plan_.topology, *frame, c_.raytraced, light.record};
    tried.lights.push_back(measure_ends(in, {c_.measure, find_measure("edge")}));
    if (map.size < c_.raster.options.map.size)
      texel_pixels_ = std::max(texel_pixels_, texel_pixels(in, light.labels));
  }
  return tried;
}

Trials::Halved Trials::halve(int times) {
  raster::MapOptions map = asked_options(c_);
  map.size >>= times;
  Halved out;
  out.tried = draw(map);
  if (!out.tried) return out;
  out.fine = std::all_of(out.tried->lights.begin(), out.tried->lights.end(), is_fine);
  out.more = halvings(map.size, texel_pixels_);
  return out;
}

/// A smaller map is kept whose edges are fine, and for which this very search, begun there, finds no smaller one.
void Trials::draw_smaller() {
  if (!raster::reads_setting(c_.raster.options.map, "map-size")) return;
  double pixels = 0.0;
  for (const LightComparison& light : c_.lights) pixels = std::max(pixels, light.theory.aliasing.median);
  int times = halvings(c_.raster.options.map.size, pixels);
  std::map<int, Halved> known;
  while (times > 0 && known.count(times) == 0 && may_go_on()) {
    const Halved& here = known[times] = halve(times);
    times += here.fine ? here.more : -1;
  }
  for (auto& [halved, at] : known) {
    const auto next = known.find(halved + 1);
    const bool next_is_coarse = next != known.end() && next->second.tried && !next->second.fine;
    if (!at.fine || (at.more > 0 && !(at.more == 1 && next_is_coarse))) continue;
    c_.tried.push_back(std::move(*at.tried));
    return;
  }
}

/// The light that is off most.
const LightComparison& worst_light(const Comparison& c) {
  return *std::max_element(c.lights.begin(), c.lights.end(), [&](const auto& a, const auto& b) {
    return std::pair(c.measure->of(a), a.error.mean_absolute) <
           std::pair(c.measure->of(b), b.error.mean_absolute);
  });
}

bool has_errors_to_tell(const Comparison& c) {
  return !c.judged && !c.lights.empty() && !c.raster.custom_shader &&
         std::any_of(c.lights.begin(), c.lights.end(),
                     [](const auto& light) { return light.pixels.compared > 0; });
}

}  // namespace

void try_settings(Comparison& c, const Plan& plan, const Redraw& redraw) {
  if (!has_errors_to_tell(c) || c.lights.front().labels.size != c.raytraced.receiver.size) return;
  const TimedStage stage("advice");
  Trials trials(c, plan, redraw);
  if (std::all_of(c.lights.begin(), c.lights.end(), is_fine)) {
    trials.draw_smaller();
    return;
  }
  const LightComparison& worst = worst_light(c);
  for (const Candidate& candidate : candidates(c, worst)) {
    if (!trials.may_go_on()) return;
    auto tried = trials.draw(candidate.map);
    if (!tried) return;
    c.tried.push_back(std::move(*tried));
    const bool helps = best_tried(c, worst, kind_of(c.tried.back(), asked_options(c))) == &c.tried.back();
    if (helps && candidate.alone) return;
  }
}

const TriedSetting* best_tried(const Comparison& c, const LightComparison& light, TriedKind kind) {
  const Left now = left_by(light, *c.measure);
  const TriedSetting* best = nullptr;
  double least = kind == TriedKind::larger_map ? (1.0 - clear_gain_of_size) * now.measured : now.measured;
  for (const TriedSetting& tried : c.tried) {
    if (kind_of(tried, asked_options(c)) != kind) continue;
    if (kind == TriedKind::smaller_map) return has_fine_edges(left_of(tried, light)) ? &tried : nullptr;
    const Left left = left_by(left_of(tried, light), *c.measure);
    if (left.measured < least && is_worth_advising(left, now, light.pixels.compared))
      best = &tried, least = left.measured;
  }
  return best;
}

bool has_fine_edges(const LightFigures& light) {
  constexpr double most_pixels = 0.5, most_mean = 0.005;
  const double off = light.error.mean_absolute * static_cast<double>(light.pixels.compared);
  return light.edges.edges > 0 && light.edges.rms_pixels < most_pixels &&
         off < most_pixels * static_cast<double>(light.edges.edges) && light.error.mean_absolute < most_mean;
}

const LightFigures& left_of(const TriedSetting& tried, const LightComparison& light) {
  return tried.lights[light.record];
}

}  // namespace gnomon::compare
