#include "studies/tune/tune.h"

#include <algorithm>
#include <numeric>

#include "compare/result/figures.h"
#include "raster/technique_traits.h"
#include "studies/tune/tuner.h"

namespace gnomon::studies {
namespace {

using compare::Setting;

// How much dearer than the best answer a drawing may be before larger maps are given up: more than single
// times are off.
constexpr double hope = 1.5;
// How far above the goal an estimate must lie to be believed.
constexpr double clearly = 2.0;
// How much dearer than the best answer an exact technique may be at the size first tried before its other sizes are left.
constexpr double exact_hope = 3.0;
// Of two estimates the later may be less by this factor: texels wider than what casts the shadows do not yet
// halve their errors.
constexpr double agreed = 0.8;
constexpr int curve_points = 129;

}  // namespace

namespace {

// Whether the two draw the same passes: all but the bias, and which sides of surfaces the map holds.
bool cost_the_same(raster::MapOptions a, raster::MapOptions b) {
  a.bias = b.bias = {};
  a.cull = b.cull = raster::Cull::none;
  return a == b;
}

// An error of a + b / size, told by two sizes: a.
double error_left(const Attempt& small, const Attempt& large) {
  return (large.error * large.size - small.error * small.size) / (large.size - small.size);
}

// Costs of a + b * size^2, told by two sizes, at a third; of one size, or where the larger cost less, no more than that one's.
double cost_at(int size, const std::vector<Attempt>& tried) {
  const Attempt& last = tried.back();
  if (tried.size() < 2) return last.cost;
  const Attempt& before = tried[tried.size() - 2];
  const auto area = [](int side) { return double(side) * side; };
  const double grown = (last.cost - before.cost) / (area(last.size) - area(before.size));
  return last.cost + std::max(0.0, grown) * (area(size) - area(last.size));
}

}  // namespace

bool Tuner::hopeless(const Attempt& a) const {
  return options_.goal.max_error.has_value() && a.cost > hope * least_cost_;
}

Setting Tuner::setting_of(const TuneFamily& family, int size, const raster::Bias& bias) const {
  Setting setting = base_;
  setting.raster.map = family.map;
  setting.raster.map.size = size;
  setting.raster.map.bias = bias;
  setting.raster.runs = std::min(base_.raster.runs, 1);
  return setting;
}

Expected<Attempt> Tuner::draw(const TuneFamily& family, int size, const raster::Bias& bias,
                              compare::GapLists* gaps, bool timed) {
  if (progress_) progress_(family, size, renders_);
  Setting setting = setting_of(family, size, bias);
  if (!timed) setting.raster.runs = 0;
  ++renders_;
  auto probe = engine_.probe(setting, options_.goal.measure());
  if (!probe) return fail(probe.error());
  if (compare::says_nothing({&options_.goal.measure()}, probe->lights))
    return fail(ErrorKind::bad_input,
                "no pixel can be compared: the camera sees no surface that a light could reach");
  Attempt attempt;
  attempt.size = size;
  attempt.bias = bias;
  attempt.bias_world = probe->bias_world;
  set_figures(probe->lights, options_.goal.measure(), attempt);
  attempt.time_ms = probe->raster_ms;
  attempt.cost = options_.cost ? options_.cost(setting, *probe) : probe->raster_ms;
  attempt.compared = probe->compared;
  attempt.texel_world = probe->texel_world;
  attempt.map_texels = probe->map_texels;
  attempt.map_bytes = probe->map_bytes;
  attempt.rays = probe->rays;
  attempt.custom_shader = probe->custom_shader;
  attempt.reads_bias = probe->reads_bias;
  if (gaps == nullptr || !probe->best) return attempt;
  *gaps = std::move(probe->gaps);
  attempt.best = *probe->best;
  attempt.bias = probe->bias_at_best;
  set_figures(probe->lights_at_best, options_.goal.measure(), attempt);
  return attempt;
}

void set_figures(const std::vector<compare::LightFigures>& lights, const compare::Figure& measure,
                 Attempt& attempt) {
  attempt.lights = lights;
  attempt.error = 0.0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double error = measure.of(lights[i]);
    if (i == 0 || !(error <= attempt.error)) attempt.error = error, attempt.figures = lights[i];
  }
}

bool is_good(const TuneGoal& goal, const Attempt& a) {
  if (!goal.max_error) return a.cost <= *goal.max_time_ms;
  return compare::is_kept(*goal.max_error, a.lights);
}

// One drawing tells the error of every constant bias, but where a shader of the user's own decides.
Expected<Attempt> Tuner::attempt_from_gaps(const TuneFamily& family, int size) {
  compare::GapLists gaps;
  auto attempt = draw(family, size, family.map.bias, &gaps);
  if (!attempt) return attempt;
  if (attempt->custom_shader) return attempt_by_trial(family, size);
  const double drawn_with = attempt->bias_world;
  attempt->bias_world = attempt->best.constant_world;
  attempt->curve =
      compare::draw_bias_curve(gaps, attempt->texel_world, drawn_with, attempt->bias_world, curve_points);
  if (family.map.bias.slope == 0.0) hard_bias_.emplace(size, attempt->bias_world);
  return attempt;
}

// The family's own and a part of it (of an automatic one also a texel), and what hard shadows need at this
// size, once and twice.
std::vector<raster::Bias> Tuner::biases_to_try(const TuneFamily& family, int size) const {
  std::vector<raster::Bias> biases;
  const bool automatic = family.map.bias.unit == raster::BiasUnit::automatic;
  for (const double factor : tried_closed_forms) {
    biases.push_back(family.map.bias);
    if (automatic && factor == 1.0) biases.back().unit = raster::BiasUnit::texel;
    if (!automatic) biases.back().constant *= factor;
  }
  if (const auto known = hard_bias_.find(size); known != hard_bias_.end())
    for (const double factor : tried_of_hard) {
      biases.push_back(family.map.bias);
      biases.back().constant = factor * known->second;
      biases.back().unit = raster::BiasUnit::world;
      biases.back() = compare::with_three_digits(biases.back());
    }
  return biases;
}

// What was best at the last size comes first. A bias changes nothing of the cost: one drawing is timed, and
// the first bias that is good enough will do; where that one is far from it, the others are as well.
Expected<Attempt> Tuner::attempt_by_trial(const TuneFamily& family, int size) {
  const std::vector<raster::Bias> biases = biases_to_try(family, size);
  std::vector<std::size_t> order(biases.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const bool known = tried_before_ && best_trial_ < biases.size();
  if (known) std::rotate(order.begin(), order.begin() + std::ptrdiff_t(best_trial_), order.end());
  std::optional<Attempt> best;
  for (const std::size_t i : order) {
    auto attempt = draw(family, size, biases[i], nullptr, !best);
    if (!attempt) return attempt;
    if (best && !options_.cost) attempt->cost = best->cost;
    if (best) attempt->time_ms = best->time_ms;
    if (!best || attempt->error < best->error) best = std::move(*attempt), best_trial_ = i;
    tried_before_ = true;
    if (!best->reads_bias) break;
    if (!options_.goal.max_error) continue;
    if (good(*best) || hopeless(*best) || (known && best->error > clearly * options_.goal.max_error->limit))
      break;
  }
  return *best;
}

Expected<Attempt> Tuner::attempt(const TuneFamily& family, int size) {
  // What a bias does to flips does not follow from one drawing: they are counted with the family's own.
  const bool own_bias = family.keeps_bias || !raster::compares_depths(family.map.technique) ||
                        options_.goal.measure().needs == compare::FigureNeeds::film;
  if (own_bias) return draw(family, size, family.map.bias, nullptr);
  return compare::biases_follow_from_gaps(family.map) ? attempt_from_gaps(family, size)
                                                      : attempt_by_trial(family, size);
}

void Tuner::consider(FamilyResult& result, const Attempt& attempt) const {
  result.tried.push_back(attempt);
  result.tried.back().curve.clear();
  if (result.closest.size == 0 || shortfall(attempt) < shortfall(result.closest)) result.closest = attempt;
  if (good(attempt) && (!result.answer || price(attempt) < price(*result.answer))) result.answer = attempt;
}

std::size_t Tuner::sizes_for(const TuneFamily& family, FamilyResult& result) const {
  std::size_t count = options_.sizes.size();
  if (!options_.goal.max_error) return count;
  for (const FamilyResult* other : answered_) {
    if (!cost_the_same(other->family.map, family.map)) continue;
    const auto at = std::find(options_.sizes.begin(), options_.sizes.end(), other->answer->size);
    const auto below = std::max<std::size_t>(1, static_cast<std::size_t>(at - options_.sizes.begin()));
    if (below < count) count = below, result.stop = TuneStop::no_smaller, result.like = other->family.name;
  }
  return count;
}

// After a size that is not good enough.
void Tuner::stop_early(const Attempt& attempt, FamilyResult& result) const {
  if (hopeless(attempt)) result.stop = TuneStop::too_dear;
  const std::size_t n = result.tried.size();
  if (n < 3) return;
  const Attempt &first = result.tried[n - 3], &second = result.tried[n - 2];
  if (!(first.size < second.size && second.size < attempt.size)) return;
  const double left = error_left(second, attempt), before = error_left(first, second);
  if (left > clearly * options_.goal.max_error->limit && left > agreed * before)
    result.stop = TuneStop::levels_off, result.floor = left;
}

// The least size that is good enough, or the largest that is cheap enough: both goals change once along the
// sizes. Where the middle one is not good enough the next larger ones come one by one. The larger a map
// the dearer the drawing, and the sooner a family can be left: before the drawing, where the two last tell its cost.
Expected<FamilyResult> Tuner::bisect(const TuneFamily& family) {
  FamilyResult result;
  result.family = family;
  const bool want_least = options_.goal.max_error.has_value();
  std::size_t low = 0, high = sizes_for(family, result);  // the change lies in [low, high]
  while (low < high) {
    const bool upwards = want_least && low > 0;
    const std::size_t middle = upwards ? low : low + (high - low) / 2;
    if (upwards && !result.answer && cost_at(options_.sizes[middle], result.tried) > hope * least_cost_) {
      result.stop = TuneStop::too_dear;
      break;
    }
    const auto attempt = this->attempt(family, options_.sizes[middle]);
    if (!attempt) return fail(attempt.error());
    consider(result, *attempt);
    if (good(*attempt) == want_least) {
      high = middle;
      if (want_least) result.answer = *attempt;  // the smaller the cheaper, whatever one rough time says
      continue;
    }
    low = middle + 1;
    if (!want_least || low >= high || result.answer) continue;
    const TuneStop before = result.stop;
    stop_early(*attempt, result);
    if (result.stop != before) break;
  }
  return result;
}

// From the middle size on, to larger or to smaller maps, while they cost less.
Expected<FamilyResult> Tuner::walk_down(const TuneFamily& family) {
  FamilyResult result;
  result.family = family;
  const auto count = static_cast<std::ptrdiff_t>(options_.sizes.size());
  const std::ptrdiff_t start = count / 2;
  double least = 0.0;
  bool moved = false;
  const auto cheaper = [&](std::ptrdiff_t i) -> Expected<bool> {
    const auto attempt = this->attempt(family, options_.sizes[static_cast<std::size_t>(i)]);
    if (!attempt) return fail(attempt.error());
    consider(result, *attempt);
    const bool less = i == start || attempt->cost < least;
    if (less) least = attempt->cost;
    return less;
  };
  if (const auto first = cheaper(start); !first) return fail(first.error());
  if (least > exact_hope * least_cost_) return result;
  for (const std::ptrdiff_t step : {+1, -1}) {
    for (std::ptrdiff_t i = start + step; !(moved && step < 0) && i >= 0 && i < count; i += step) {
      const auto less = cheaper(i);
      if (!less) return fail(less.error());
      if (!*less) break;
      moved = moved || step > 0;
    }
  }
  return result;
}

Expected<FamilyResult> Tuner::search(const TuneFamily& family) {
  tried_before_ = false;
  auto found = !raster::compares_depths(family.map.technique) ? walk_down(family) : bisect(family);
  if (!found || !found->answer) return found;
  if (options_.found && options_.goal.max_error && found->answer->cost < least_cost_)
    options_.found(family, *found->answer, renders_);
  least_cost_ = std::min(least_cost_, found->answer->cost);
  return found;
}

// Exact techniques last: they are good at any size, so that what they cost is all there is to learn of them.
Expected<void> Tuner::search_all(TuneResult& result) {
  result.families.resize(options_.families.size());
  for (const bool exact : {false, true})
    for (std::size_t i = 0; i < options_.families.size(); ++i) {
      if (raster::compares_depths(options_.families[i].map.technique) == exact) continue;
      FamilyResult& family = result.families[i];
      family.family = options_.families[i];
      if (searched_ && begun_.elapsed_ms() > 1e3 * options_.most_seconds) continue;
      auto found = search(options_.families[i]);
      if (!found) return fail(found.error());
      searched_ = true;
      family = std::move(*found);
      if (family.answer) answered_.push_back(&family);
    }
  return {};
}

Expected<TuneResult> Tuner::run() {
  TuneResult result;
  if (auto searched = search_all(result); !searched) return fail(searched.error());
  if (auto chosen = choose(result); !chosen) return fail(chosen.error());
  result.renders = renders_;
  explain(result);
  return result;
}

Expected<TuneResult> tune(Engine& engine, const Setting& base, const TuneOptions& options,
                          const TuneProgress& progress) {
  return Tuner(engine, base, options, progress).run();
}

}  // namespace gnomon::studies
