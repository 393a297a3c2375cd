// The cheapest setting that is good enough, or the best one that is cheap enough, from far fewer drawings
// than a grid.
//
// Each family (a technique with its kind of bias) is searched over map sizes. Larger maps cost more and are
// wrong less. So the least size good enough, or the largest one cheap enough, is found by bisection. At each
// size one drawing gives the error of every constant bias (bias_curve.h), and with it the best one; where a
// technique's drawings do not tell that, the closed-form bias of its size and what hard shadows need there
// are tried. The smallest maps that any family is to try come first, and those together that draw the same map.
// A family is left as soon as it costs clearly more than the best so far without being good
// enough. It is also left where its error levels off above the goal. A sampling error halves with every
// doubling of the map, so that two sizes tell what is left without it; three have to agree. And it is left at
// the size where a family like it is good enough: biases change no cost. The first family, the plain map, is
// searched to its end: others are held against it. Exact techniques (izb, hybrid) are
// right at any size, and their cost has a least size of its own: it is walked down to. The families that come
// close to the best are then drawn at their own biases, in turn and several times over. The least times
// decide, but for those that lie within the spread. Of them one that costs less whatever the machine is
// preferred. The winner is then compared as its command would; where it is not good enough there, the next
// one takes its place.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compare/bias/bias_advice.h"
#include "compare/result/engine_units.h"
#include "raster/settings.h"
#include "studies/sweep/engine.h"

namespace gnomon::studies {

struct TuneGoal {
  std::optional<compare::Threshold> max_error;
  std::optional<double> max_time_ms;  ///< map and shading; exactly one of the two is given
  const compare::Figure* of_time = &compare::wrong_and_mean();  ///< what is to be small within max_time_ms
  /// What errors are counted in.
  const compare::Figure& measure() const { return max_error ? *max_error->measure : *of_time; }
};

/// A technique with everything but map size and constant bias.
struct TuneFamily {
  std::string name;  ///< as people say it: "slope bias 1"
  raster::MapOptions map;
  bool keeps_bias = false;  ///< its constant stays as it is: an engine has none

  bool has_map() const { return raster::reads_setting(map, "map-size"); }
  /// "pcf, 512 texels"; the name alone where there is no map.
  std::string at_size(int texels) const;
};

/// What a drawing costs; the milliseconds of map and shading where none is given. One that does not depend on
/// the machine is for tests.
using TuneCost = std::function<double(const compare::Setting& setting, const Probe& probe)>;

struct TuneOptions {
  TuneGoal goal;
  std::vector<TuneFamily> families;
  std::vector<int> sizes;  ///< ascending, texels
  TuneCost cost;           ///< empty: milliseconds
  /// Processor time after which the first family alone is searched on, seconds, from the call of tune() on.
  double most_seconds = std::numeric_limits<double>::infinity();
  /// Told of each family whose answer is cheaper than those before, where the goal is an error.
  std::function<void(const TuneFamily& family, const struct Attempt& answer, std::uint64_t renders)> found;
  bool quick = false;  ///< the first setting that meets the goal ends the search
  /// The setting that a family's answer is given as; empty: the one that it was drawn with. The answer's
  /// error is measured by the comparison at this setting.
  std::function<Expected<compare::Setting>(std::size_t family, const struct Attempt& answer)> as_given;
};

/// One drawing, at its best constant bias.
struct Attempt {
  int size = 0;
  raster::Bias bias;                          ///< as it was tried, and as the attempt's command asks for it
  double bias_world = 0.0;                    ///< its constant, of the first light
  double error = 0.0;                         ///< what TuneGoal::measure() says, of the worst light
  compare::LightFigures figures;              ///< of that light
  std::vector<compare::LightFigures> lights;  ///< of all that are compared
  double time_ms = 0.0;                       ///< least of `times`, or of the search's one drawing
  double cost = 0.0;                          ///< by TuneOptions::cost
  Times times;                                ///< measured in turn with the others; empty: not among the best
  std::uint64_t map_texels = 0, map_bytes = 0, rays = 0;
  compare::BestBias best;      ///< of all lights; with the proof, where no constant bias is right everywhere
  std::uint64_t compared = 0;  ///< pixels, all lights
  std::vector<compare::BiasCurvePoint> curve;  ///< empty where biases do not follow from gaps
  double texel_world = 0.0;                    ///< a texel's width, as the rasterizer takes it for biases
  /// Tell, as in Probe, whether a shader of the user's own decided, and whether it reads the bias.
  bool custom_shader = false, reads_bias = true;
};

/// Whether `best` proves that no constant bias is right everywhere, which is an answer to goals that count wrong pixels.
/// Where a drawing tells the error of every bias, some shadowed pixels stand in the way.
inline bool has_proof(const Attempt& a, const compare::Figure& measure) {
  return compare::counts_biases(a.figures, measure) && !a.best.feasible && a.best.shadowed_pixels_below > 0;
}

/// Why larger maps were not tried.
enum class TuneStop : std::uint8_t {
  none,        ///< they were, or need not be
  too_dear,    ///< this one costs too much already
  levels_off,  ///< the error that larger maps lessen is not what is too much
  no_smaller,  ///< a family that differs in its bias alone is good enough there, for the same cost
  left         ///< the search was over before: TuneOptions::most_seconds, or TuneOptions::quick
};

struct FamilyResult {
  TuneFamily family;
  std::optional<Attempt> answer;  ///< the cheapest (or best) that meets the goal
  Attempt closest;                ///< otherwise the one that comes nearest to it
  TuneStop stop = TuneStop::none;
  double floor = 0.0;  ///< levels_off: the share of wrong pixels that no map size lessens, as estimated
  std::string like;    ///< no_smaller: that family's name
  std::vector<Attempt> tried;  ///< each size drawn, at its best bias, without curves
  /// Names, for the winner, the families whose times lie within the spread of its own. Where the goal is a time, their error
  /// must be the same, too. Tells whether the winner was preferred to the fastest of them for rendering fewer texels, taking
  /// fewer bytes or casting fewer rays.
  std::vector<std::string> as_fast;
  bool by_cost = false;
  std::string why;  ///< why it lost, or won

  /// Drawn at least once: not left for lack of time.
  bool is_tried() const { return !tried.empty(); }

  /// The answer, or what comes nearest to one.
  const Attempt& attempt() const { return answer ? *answer : closest; }
  Attempt& attempt() { return answer ? *answer : closest; }
};

/// A setting that would be more accurate than the answer, but for a time that may be within the limit or not.
struct JustOver {
  std::size_t family = 0;  ///< index in TuneResult::families
  Attempt attempt;
};

struct TuneResult {
  bool feasible = false;
  std::size_t winner = 0;  ///< index in families; the one that comes nearest when nothing is feasible
  std::vector<FamilyResult> families;
  std::uint64_t renders = 0;
  std::vector<JustOver> just_over;  ///< where the goal is a time (ties.h)
  /// The winner's bias as engines ask for it, of each light compared, and the one that follows from its map alone
  /// (engine_units.h).
  struct LightUnits {
    std::string light;  ///< its name; may be empty
    std::vector<compare::EngineUnit> units;
    compare::DerivedForEngines derived{};
  };
  std::vector<LightUnits> engine_units;
  compare::ViewErrors views;  ///< of the winner, where it was judged from several
};

/// Called before each drawing with the family and the size.
using TuneProgress = std::function<void(const TuneFamily& family, int size, std::uint64_t renders)>;

/// How many biases a technique is tried with whose gaps do not tell them, and which. They are multiples of
/// the bias of its family, and of the best bias of hard shadows at the same size.
inline constexpr std::array<double, 2> tried_closed_forms{1.0, 0.25}, tried_of_hard{1.0, 2.0};

/// `base` gives everything but the map's options; its runs say how often the best are drawn again.
Expected<TuneResult> tune(Engine& engine, const compare::Setting& base, const TuneOptions& options,
                          const TuneProgress& progress = {});

}  // namespace gnomon::studies
