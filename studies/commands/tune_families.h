// What the tuner chooses from: the combinations of the options that were given as lists, and of defaults
// where nothing was said.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/lesson_scene.h"
#include "compare/result/engines.h"
#include "studies/commands/axes.h"
#include "studies/tune/tune.h"

namespace gnomon::app {

/// A family and the options that make it.
struct OptionFamily {
  studies::TuneFamily tuned;
  OptionValues values;
};

/// What is tried when no technique is named: cube is the map that hard has of a point light.
std::vector<std::string> tuned_techniques();

/// An option was given one value, or several.
bool is_given(const OptionValues& fixed, const studies::Grid& grid, const std::string& name);

/// Every technique, with each kind of bias that goes with it, unless `options` say which; `filmed`: with the bias that
/// each has anyway, snapped and not. Errors are ErrorKind::usage.
/// An engine that is named leaves what it draws.
Expected<std::vector<OptionFamily>> make_families(const SweepOptions& options, bool filmed = false,
                                                  const compare::TunedEngine* engine = nullptr);

/// Without the techniques that have no map for a light compared, and without what the engine cannot be told of it.
Expected<std::vector<OptionFamily>> fitting_families(const std::vector<OptionFamily>& families,
                                                     const Scene& scene,
                                                     const std::vector<std::uint32_t>& lights,
                                                     const compare::TunedEngine* engine = nullptr);

}  // namespace gnomon::app
