#include "studies/tune/tune.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "compare/result/figures.h"
#include "compare/result/number_text.h"
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

std::string TuneFamily::at_size(int texels) const {
  return has_map() ? fmt::format("{}, {}", name, compare::with_noun(std::to_string(texels), "texel")) : name;
}

namespace {

// Whether the two draw the same passes: all but the bias, and which sides of surfaces the map holds.
bool cost_the_same(raster::MapOptions a, raster::MapOptions b) {
  a.bias = b.bias = {};
  a.cull = b.cull = raster::Cull::none;
  return a == b;
}

// Whether the renderer draws one map for the two, of one size.
bool draw_the_same_map(const raster::MapOptions& a, const raster::MapOptions& b) {
  const raster::TechniqueTraits &of_a = raster::traits_of(a.technique),
                                &of_b = raster::traits_of(b.technique);
  return of_a.texels == of_b.texels && of_a.contents == of_b.contents &&
         raster::effective_options(a).cull == raster::effective_options(b).cull;
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
    const double error = compare::ranked(measure.of(lights[i]));
    if (i == 0 || !(error <= attempt.error)) attempt.error = error, attempt.figures = lights[i];
  }
}

bool is_good(const TuneGoal& goal, const Attempt& a) {
  if (!goal.max_error) return a.cost <= *goal.max_time_ms;
  return compare::is_kept(*goal.max_error, a.lights);
}

// One drawing tells the error of every constant bias, but where a shader of the user's own decides.
Expected<Attempt> Tuner::attempt_from_gaps(Trials& trials, const TuneFamily& family, int size) {
  compare::GapLists gaps;
  auto attempt = draw(family, size, family.map.bias, &gaps);
  if (!attempt) return attempt;
  if (attempt->custom_shader) return attempt_by_trial(trials, family, size);
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
Expected<Attempt> Tuner::attempt_by_trial(Trials& trials, const TuneFamily& family, int size) {
  const std::vector<raster::Bias> biases = biases_to_try(family, size);
  std::vector<std::size_t> order(biases.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const bool known = trials.best < biases.size();
  if (known) std::rotate(order.begin(), order.begin() + std::ptrdiff_t(trials.best), order.end());
  std::optional<Attempt> best;
  for (const std::size_t i : order) {
    auto attempt = draw(family, size, biases[i], nullptr, !best);
    if (!attempt) return attempt;
    if (best && !options_.cost) attempt->cost = best->cost;
    if (best) attempt->time_ms = best->time_ms;
    if (!best || attempt->error < best->error) best = std::move(*attempt), trials.best = i;
    if (!best->reads_bias) break;
    if (!options_.goal.max_error) continue;
    if (good(*best) || hopeless(*best) || (known && best->error > clearly * options_.goal.max_error->limit))
      break;
  }
  return *best;
}

Expected<Attempt> Tuner::attempt(Trials& trials, const TuneFamily& family, int size) {
  // What a bias does to flips does not follow from one drawing: they are counted with the family's own.
  const bool own_bias = family.keeps_bias || !raster::compares_depths(family.map.technique) ||
                        options_.goal.measure().needs == compare::FigureNeeds::film;
  if (own_bias) return draw(family, size, family.map.bias, nullptr);
  return compare::biases_follow_from_gaps(family.map) ? attempt_from_gaps(trials, family, size)
                                                      : attempt_by_trial(trials, family, size);
}

void Tuner::consider(FamilyResult& result, const Attempt& attempt) const {
  result.tried.push_back(attempt);
  result.tried.back().curve.clear();
  if (result.closest.size == 0 || shortfall(attempt) < shortfall(result.closest)) result.closest = attempt;
  if (good(attempt) && (!result.answer || price(attempt) < price(*result.answer))) result.answer = attempt;
}

// After a size that is not good enough.
void Tuner::stop_early(const Attempt& attempt, FamilyResult& result) const {
  if (&result != first_ && hopeless(attempt)) result.stop = TuneStop::too_dear;
  const std::size_t n = result.tried.size();
  if (n < 3) return;
  const Attempt &first = result.tried[n - 3], &second = result.tried[n - 2];
  if (!(first.size < second.size && second.size < attempt.size)) return;
  const double left = error_left(second, attempt), before = error_left(first, second);
  if (left > clearly * options_.goal.max_error->limit && left > agreed * before)
    result.stop = TuneStop::levels_off, result.floor = left;
}

// Where another family that costs the same is good enough at a size, only those below can win; one is tried of every family.
void Tuner::leave_sizes_of_others(const std::vector<Course>& all, Course& course) const {
  if (!options_.goal.max_error) return;
  for (const Course& other : all) {
    const FamilyResult& found = *other.result;
    if (&other == &course || !found.answer || !cost_the_same(found.family.map, course.result->family.map))
      continue;
    const auto at = std::find(options_.sizes.begin(), options_.sizes.end(), found.answer->size);
    const auto below = std::max<std::size_t>(1, static_cast<std::size_t>(at - options_.sizes.begin()));
    if (below >= course.high) continue;
    course.high = below;
    course.result->stop = TuneStop::no_smaller, course.result->like = found.family.name;
  }
}

// The first family is searched to its end: it is the plain map that others are held against, and there is an answer whatever
// the time.
bool Tuner::gives_up(const Course& course, std::size_t size) const {
  const FamilyResult& result = *course.result;
  if (&result == first_ || result.answer) return false;
  if (out_of_time()) return true;
  return options_.goal.max_error && !result.tried.empty() &&
         cost_at(options_.sizes[size], result.tried) > hope * least_cost_;
}

// The least size that is good enough, or the largest that is cheap enough: both goals change once along the
// sizes, between `low` and `high`. Where the middle one is not good enough the next larger ones come one by one. The larger a
// map the dearer the drawing, and the sooner a family can be left: before the drawing, where the two last tell its cost.
std::optional<std::size_t> Tuner::next_size(const std::vector<Course>& all, Course& course) const {
  if (course.over) return std::nullopt;
  leave_sizes_of_others(all, course);
  course.over = course.low >= course.high;
  if (course.over) return std::nullopt;
  const bool upwards = options_.goal.max_error && course.low > 0;
  const std::size_t size = upwards ? course.low : course.low + (course.high - course.low) / 2;
  course.over = gives_up(course, size);
  if (!course.over) return size;
  course.result->stop = out_of_time() ? TuneStop::left : TuneStop::too_dear;
  return std::nullopt;
}

Expected<void> Tuner::advance(Course& course, std::size_t size) {
  FamilyResult& result = *course.result;
  const auto attempt = this->attempt(course.trials, result.family, options_.sizes[size]);
  if (!attempt) return fail(attempt.error());
  consider(result, *attempt);
  const bool want_least = options_.goal.max_error.has_value();
  if (good(*attempt) == want_least) {
    course.high = size;
    if (want_least) result.answer = *attempt;  // the smaller the cheaper, whatever one rough time says
  } else {
    course.low = size + 1;
    if (want_least && course.low < course.high && !result.answer) {
      const TuneStop before = result.stop;
      stop_early(*attempt, result);
      course.over = result.stop != before;
    }
  }
  if (result.answer) least_cost_ = std::min(least_cost_, result.answer->cost);
  return {};
}

// From the middle size on, to larger or to smaller maps, while they cost less.
Expected<void> Tuner::walk_down(FamilyResult& result) {
  Trials trials;
  const auto count = static_cast<std::ptrdiff_t>(options_.sizes.size());
  const std::ptrdiff_t start = count / 2;
  double least = 0.0;
  bool moved = false;
  const auto cheaper = [&](std::ptrdiff_t i) -> Expected<bool> {
    const auto attempt = this->attempt(trials, result.family, options_.sizes[static_cast<std::size_t>(i)]);
    if (!attempt) return fail(attempt.error());
    consider(result, *attempt);
    const bool less = i == start || attempt->cost < least;
    if (less) least = attempt->cost;
    return less;
  };
  if (const auto first = cheaper(start); !first) return fail(first.error());
  if (!raster::reads_setting(result.family.map, "map-size")) return {};
  if (least > exact_hope * least_cost_) return {};
  for (const std::ptrdiff_t step : {+1, -1}) {
    for (std::ptrdiff_t i = start + step; !(moved && step < 0) && i >= 0 && i < count; i += step) {
      const auto less = cheaper(i);
      if (!less) return fail(less.error());
      if (!*less) break;
      moved = moved || step > 0;
    }
  }
  return {};
}

bool Tuner::out_of_time() const {
  return begun_.elapsed_ms() > 1e3 * options_.most_seconds;
}

// Told of a family whose search is over, and of no other that is dearer.
void Tuner::tell(const FamilyResult& result) {
  if (!result.answer || !options_.goal.max_error || !(result.answer->cost < told_cost_)) return;
  told_cost_ = result.answer->cost;
  if (options_.found) options_.found(result.family, *result.answer, renders_);
}

void Tuner::leave_all(std::span<const Course> courses) {
  for (const Course& course : courses)
    if (!course.over && !course.result->answer) course.result->stop = TuneStop::left;
}

// The smallest maps that are still to be drawn come first, whatever their families: what is found by cheap drawings leaves out
// dear ones. Of one size those come together that draw the same map, which is then drawn once, and the cheaper ones before.
Expected<void> Tuner::search_maps(const std::vector<FamilyResult*>& results) {
  std::vector<Course> courses;
  for (FamilyResult* result : results) courses.push_back({.result = result, .high = options_.sizes.size()});
  const raster::MapOptions* drawn_last = nullptr;
  for (;;) {
    Course* least = nullptr;
    std::size_t size = 0;
    const auto order = [&](const Course& course, std::size_t of_size) {
      const FamilyResult& result = *course.result;
      const bool other_map = drawn_last == nullptr || !draw_the_same_map(*drawn_last, result.family.map);
      return std::tuple(of_size, other_map, result.tried.empty() ? 0.0 : result.tried.back().cost);
    };
    for (Course& course : courses)
      if (const auto next = next_size(courses, course);
          next && (least == nullptr || order(course, *next) < order(*least, size)))
        least = &course, size = *next;
    if (least == nullptr) return {};
    drawn_last = &least->result->family.map;
    if (auto drawn = advance(*least, size); !drawn) return drawn;
    if (options_.quick && least->result->answer) return leave_all(courses), Expected<void>{};
    if (!next_size(courses, *least)) tell(*least->result);
  }
}

// Exact techniques last: they are good at any size, so that what they cost is all there is to learn of them.
Expected<void> Tuner::search_all(TuneResult& result) {
  result.families.resize(options_.families.size());
  std::vector<FamilyResult*> maps, exact;
  for (std::size_t i = 0; i < options_.families.size(); ++i) {
    FamilyResult& family = result.families[i];
    family.family = options_.families[i];
    (raster::compares_depths(family.family.map.technique) ? maps : exact).push_back(&family);
  }
  first_ = maps.empty() ? exact.front() : maps.front();
  if (auto searched = search_maps(maps); !searched) return searched;
  for (FamilyResult* family : exact) {
    if (family != first_ && (out_of_time() || (options_.quick && least_cost_ < infinity))) continue;
    if (auto walked = walk_down(*family); !walked) return walked;
    if (family->answer) least_cost_ = std::min(least_cost_, family->answer->cost);
    tell(*family);
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
