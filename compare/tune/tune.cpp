#include "compare/tune/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compare/number_text.h"

namespace gnomon::compare {
namespace {

class Tuner {
 public:
  Tuner(Engine& engine, const Setting& base, const TuneOptions& options, const TuneProgress& progress)
      : engine_(engine), base_(base), options_(options), progress_(progress) {}

  Expected<TuneResult> run();

 private:
  bool good(const Attempt& a) const {
    return options_.goal.max_error ? a.error <= *options_.goal.max_error
                                   : a.time_ms <= *options_.goal.max_time_ms;
  }
  // What is to be small among those that are good.
  double price(const Attempt& a) const { return options_.goal.max_error ? a.time_ms : a.error; }
  // What is to be small where none is good.
  double shortfall(const Attempt& a) const { return options_.goal.max_error ? a.error : a.time_ms; }

  Expected<Probe> draw(const TuneFamily& family, int size, raster::Bias bias);
  Expected<Attempt> attempt(const TuneFamily& family, int size);
  Expected<Attempt> attempt_from_gaps(const TuneFamily& family, int size);
  Expected<Attempt> attempt_by_trial(const TuneFamily& family, int size);
  Expected<FamilyResult> search(const TuneFamily& family);
  Expected<void> confirm(FamilyResult& result);
  void explain(TuneResult& result) const;
  std::string reason(const FamilyResult& loser, const FamilyResult& winner) const;

  Engine& engine_;
  const Setting& base_;
  const TuneOptions& options_;
  const TuneProgress& progress_;
  std::uint64_t renders_ = 0;
  std::map<int, double> hard_bias_;  ///< by size, of the first family whose gaps told it
};

Expected<Probe> Tuner::draw(const TuneFamily& family, int size, raster::Bias bias) {
  if (progress_) progress_(family, size, renders_);
  Setting setting = base_;
  setting.raster.map = family.map;
  setting.raster.map.size = size;
  setting.raster.map.bias = bias;
  ++renders_;
  return engine_.probe(setting);
}

// One drawing tells the error of every constant bias.
Expected<Attempt> Tuner::attempt_from_gaps(const TuneFamily& family, int size) {
  const auto probe = draw(family, size, family.map.bias);
  if (!probe) return fail(probe.error());
  Attempt attempt;
  attempt.size = size;
  attempt.best = find_best_bias(probe->gaps);
  attempt.bias_world = attempt.best.constant_world;
  attempt.error = attempt.best.wrong_fraction;
  attempt.time_ms = probe->raster_ms;
  attempt.compared = probe->compared;
  attempt.texel_world = probe->texel_world;
  attempt.curve =
      draw_bias_curve(probe->gaps, probe->texel_world, probe->bias_world, attempt.bias_world, 129);
  if (family.map.bias.slope == 0.0) hard_bias_.emplace(size, attempt.bias_world);
  return attempt;
}

// The closed form (one texel of slope, the default) and what hard shadows need at this size, once and twice.
Expected<Attempt> Tuner::attempt_by_trial(const TuneFamily& family, int size) {
  std::vector<raster::Bias> biases{family.map.bias};
  if (const auto known = hard_bias_.find(size); known != hard_bias_.end())
    for (const double factor : {1.0, 2.0}) {
      biases.push_back(family.map.bias);
      biases.back().constant = factor * known->second;
      biases.back().unit = raster::BiasUnit::world;
    }
  std::optional<Attempt> best;
  for (const raster::Bias& bias : biases) {
    const auto probe = draw(family, size, bias);
    if (!probe) return fail(probe.error());
    Attempt attempt;
    attempt.size = size;
    attempt.bias_world = probe->bias_world;
    attempt.error = double(probe->wrong) / double(std::max<std::uint64_t>(probe->compared, 1));
    attempt.time_ms = probe->raster_ms;
    attempt.compared = probe->compared;
    attempt.texel_world = probe->texel_world;
    if (!best || attempt.error < best->error) best = attempt;
  }
  return *best;
}

Expected<Attempt> Tuner::attempt(const TuneFamily& family, int size) {
  return biases_follow_from_gaps(family.map) ? attempt_from_gaps(family, size)
                                             : attempt_by_trial(family, size);
}

// The least size that is good enough, or the largest that is cheap enough: both goals change once along the
// sizes.
Expected<FamilyResult> Tuner::search(const TuneFamily& family) {
  FamilyResult result;
  result.family = family;
  const bool want_least = options_.goal.max_error.has_value();
  std::size_t low = 0, high = options_.sizes.size();  // the change lies in [low, high]
  bool first = true;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    auto attempt = this->attempt(family, options_.sizes[middle]);
    if (!attempt) return fail(attempt.error());
    if (first || shortfall(*attempt) < shortfall(result.closest)) result.closest = *attempt;
    first = false;
    if (good(*attempt)) {
      if (!result.answer || price(*attempt) < price(*result.answer)) result.answer = *attempt;
      want_least ? high = middle : low = middle + 1;
    } else {
      want_least ? low = middle + 1 : high = middle;
    }
  }
  return result;
}

// The winner at its own bias: what is promised from the gaps is what is drawn.
Expected<void> Tuner::confirm(FamilyResult& result) {
  Attempt& answer = result.answer ? *result.answer : result.closest;
  raster::Bias bias = result.family.map.bias;
  bias.constant = answer.bias_world;
  bias.unit = raster::BiasUnit::world;
  const auto probe = draw(result.family, answer.size, bias);
  if (!probe) return fail(probe.error());
  answer.error = double(probe->wrong) / double(std::max<std::uint64_t>(probe->compared, 1));
  answer.time_ms = probe->raster_ms;
  return {};
}

std::string setting_text(const Attempt& a) {
  return fmt::format("{} wrong in {} with {} texels", percent(a.error), milliseconds(a.time_ms), a.size);
}

std::string proof(const BestBias& best) {
  if (best.feasible || best.lit_pixels_above == 0) return {};
  return fmt::format(
      "; no constant bias is right everywhere: {} lit pixels need {} or more, {} shadowed ones less "
      "than {}",
      grouped(best.lit_pixels_above), plain_number(best.needs_more_than), grouped(best.shadowed_pixels_below),
      plain_number(best.needs_less_than));
}

std::string Tuner::reason(const FamilyResult& loser, const FamilyResult& winner) const {
  if (!loser.answer)
    return (options_.goal.max_error ? "not good enough at any size: at best "
                                    : "too slow at any size: at best ") +
           setting_text(loser.closest) + proof(loser.closest.best);
  if (!winner.answer) return setting_text(*loser.answer);
  if (options_.goal.max_error) return fmt::format("slower: {}", setting_text(*loser.answer));
  return fmt::format("less accurate: {}", setting_text(*loser.answer)) + proof(loser.answer->best);
}

void Tuner::explain(TuneResult& result) const {
  const FamilyResult& winner = result.families[result.winner];
  for (std::size_t i = 0; i < result.families.size(); ++i) {
    FamilyResult& family = result.families[i];
    if (i != result.winner)
      family.why = reason(family, winner);
    else if (result.feasible)
      family.why = (options_.goal.max_error ? "the cheapest that is good enough: "
                                            : "the best that is cheap enough: ") +
                   setting_text(*family.answer);
    else
      family.why = "comes nearest: " + setting_text(family.closest) + proof(family.closest.best);
  }
}

Expected<TuneResult> Tuner::run() {
  TuneResult result;
  for (const TuneFamily& family : options_.families) {
    auto found = search(family);
    if (!found) return fail(found.error());
    result.families.push_back(std::move(*found));
  }
  const auto better = [this](const FamilyResult& a, const FamilyResult& b) {
    if (a.answer.has_value() != b.answer.has_value()) return a.answer.has_value();
    return a.answer ? price(*a.answer) < price(*b.answer) : shortfall(a.closest) < shortfall(b.closest);
  };
  result.winner = static_cast<std::size_t>(
      std::min_element(result.families.begin(), result.families.end(), better) - result.families.begin());
  FamilyResult& winner = result.families[result.winner];
  result.feasible = winner.answer.has_value();
  if (auto confirmed = confirm(winner); !confirmed) return fail(confirmed.error());
  result.renders = renders_;
  explain(result);
  return result;
}

}  // namespace

Expected<TuneResult> tune(Engine& engine, const Setting& base, const TuneOptions& options,
                          const TuneProgress& progress) {
  return Tuner(engine, base, options, progress).run();
}

}  // namespace gnomon::compare
