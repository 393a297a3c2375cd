// The tuner's insides. Parts: tune.cpp (the search), measure_in_turn.cpp (who wins), explain.cpp (why).
#pragma once

#include <limits>
#include <map>
#include <span>

#include "scene/base/timing.h"
#include "studies/tune/tune.h"

namespace gnomon::studies {

/// Sets `lights`, and `error` and `figures` of the worst of them.
void set_figures(const std::vector<compare::LightFigures>& lights, const compare::Figure& measure,
                 Attempt& attempt);
/// Whether an attempt meets the goal: where that is an error, with every light.
bool is_good(const TuneGoal& goal, const Attempt& attempt);

// What the spread of the times leaves open (ties.cpp). There are families that the times cannot tell from the best, and
// settings that cost too much by no more than one time may be off.

struct Ties {
  std::size_t chosen = 0;           ///< the family to prefer, an index
  std::vector<std::size_t> others;  ///< that tie with it
};

/// `best` is the one of `families` that comes first by error and least time, and has an answer whose times
/// were measured. Another ties with it where that is not clearly faster (time_difference.h): they are as fast; where the goal is a time, its error has to be the same as well. Of these the one is chosen that
/// renders no more texels, takes no more bytes and casts no more rays than `best`, and less of something. That holds on any
/// machine.
Ties ties_with(std::size_t best, const std::vector<FamilyResult>& families, const TuneGoal& goal);

/// Where the goal is a time: of every family the setting tried that errs least. It must err less than the
/// answer of `winner`. Its one time must lie over the limit by no more than such a time may be off.
std::vector<JustOver> just_over_limit(std::size_t winner, const std::vector<FamilyResult>& families,
                                      const TuneGoal& goal);

class Tuner {
 public:
  Tuner(Engine& engine, const compare::Setting& base, const TuneOptions& options,
        const TuneProgress& progress)
      : engine_(engine), base_(base), options_(options), progress_(progress) {}

  Expected<TuneResult> run();

 private:
  bool good(const Attempt& a) const { return is_good(options_.goal, a); }
  /// What is to be small among those that are good.
  double price(const Attempt& a) const { return options_.goal.max_error ? a.cost : a.error; }
  /// What is to be small where none is good.
  double shortfall(const Attempt& a) const { return options_.goal.max_error ? a.error : a.cost; }
  /// Costs so much more than the best answer that no larger map can win.
  bool hopeless(const Attempt& a) const;
  bool out_of_time() const;
  /// Which of the biases tried was best at the family's last size; the largest number where none was tried.
  struct Trials {
    std::size_t best = ~std::size_t{0};
  };
  /// A family's search: what is sought lies in [low, high] of the sizes.
  struct Course {
    FamilyResult* result;
    std::size_t low = 0, high = 0;
    bool over = false;
    Trials trials{};
  };
  void leave_sizes_of_others(const std::vector<Course>& all, Course& course) const;
  bool gives_up(const Course& course, std::size_t size) const;
  /// The size to draw next; none where the search is over, which the course is told.
  std::optional<std::size_t> next_size(const std::vector<Course>& all, Course& course) const;
  Expected<void> advance(Course& course, std::size_t size);
  void stop_early(const Attempt& attempt, FamilyResult& result) const;

  compare::Setting setting_of(const TuneFamily& family, int size, const raster::Bias& bias) const;
  Expected<Attempt> draw(const TuneFamily& family, int size, const raster::Bias& bias,
                         compare::GapLists* gaps, bool timed = true);
  Expected<Attempt> attempt(Trials& trials, const TuneFamily& family, int size);
  Expected<Attempt> attempt_from_gaps(Trials& trials, const TuneFamily& family, int size);
  Expected<Attempt> attempt_by_trial(Trials& trials, const TuneFamily& family, int size);
  std::vector<raster::Bias> biases_to_try(const TuneFamily& family, int size) const;
  void consider(FamilyResult& result, const Attempt& attempt) const;  ///< of the next size tried
  void tell(const FamilyResult& result);
  static void leave_all(std::span<const Course> courses);
  Expected<void> search_maps(const std::vector<FamilyResult*>& results);
  Expected<void> walk_down(FamilyResult& result);
  Expected<void> search_all(TuneResult& result);

  bool better(const FamilyResult& a, const FamilyResult& b) const;
  std::size_t best_of(const TuneResult& result) const;
  Expected<void> measure_best(TuneResult& result);
  Expected<void> measure_in_turn(const std::vector<FamilyResult*>& finalists);
  void settle(FamilyResult& result) const;
  Expected<void> confirm(FamilyResult& result);
  Expected<void> draw_again(FamilyResult& result);
  std::size_t prefer_by_cost(TuneResult& result, std::size_t fastest) const;
  Expected<void> choose(TuneResult& result);
  Expected<void> verify(TuneResult& result);

  void explain(TuneResult& result) const;
  std::string reason(const FamilyResult& loser, const FamilyResult& winner) const;

  Engine& engine_;
  const compare::Setting& base_;
  const TuneOptions& options_;
  const TuneProgress& progress_;
  std::uint64_t renders_ = 0;
  ProcessorStopwatch begun_;
  const FamilyResult* first_ = nullptr;  ///< of the first family, which is searched to its end
  std::map<int, double> hard_bias_;      ///< by size, of the first family whose gaps told it
  double least_cost_ = infinity,
         told_cost_ = infinity;  ///< of the answers so far, and of those that were told of
};

}  // namespace gnomon::studies
