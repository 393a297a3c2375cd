// What is said of a diff, on the terminal and on the page alike.
#pragma once

#include <string>

#include "studies/diff/diff.h"

namespace gnomon::studies {

/// "+0.41 %, worse"
std::string change_text(const FigureChange& change);
std::string time_text(const std::array<double, 3>& ms);
/// "620 new, 12 fixed, 1,846 as before"
std::string pixels_text(const LightDiff& light);
/// "aliasing 400, acne 220"; empty where none is new.
std::string new_labels_text(const LightDiff& light);
/// "worse"
std::string verdict_text(const Diff& diff);

}  // namespace gnomon::studies
