// By how much a figure of two results may differ though nothing got better or worse. Gnomon draws and decides the same each
// time, so that any change tells something. Chance is in three things alone: other samples of a light with size, other rays of
// technique `rays`, and another OpenGL.
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "compare/result/figures.h"

namespace gnomon::studies {

inline constexpr double unknown_spread = std::numeric_limits<double>::infinity();

/// What is known of one light in one of two results.
struct Drawn {
  const nlohmann::ordered_json& result;  ///< the whole document
  const nlohmann::ordered_json& light;   ///< its entry of "lights"
  compare::LightFigures figures;         ///< those that are pooled, of it
};

bool has_other_gl(const Drawn& before, const Drawn& after);

/// Sentences for people: what chance there is between the two. None: the same setting gives the same numbers.
std::vector<std::string> chances(const Drawn& before, const Drawn& after);

/// In the figure's unit; unknown_spread where there is chance that nothing measures.
double spread(const compare::Figure& figure, const Drawn& before, const Drawn& after);

}  // namespace gnomon::studies
