// A setting judged from several views: which of them errs most, and how that is said.
#pragma once

#include <string>

#include "compare/comparison.h"
#include "compare/result/result_parts.h"

namespace gnomon::compare {

/// Adds what the comparison's worst light errs by from there. Returns whether no view before errs more.
bool add_view(ViewErrors& errors, std::string name, const Comparison& comparison);

/// Returns the mean over the views in which something is compared; NaN where there is none.
double mean_error(const ViewErrors& errors);

/// Returns "Worst of 5 views: kitchen, 6.1 % (2.0 % in the mean)."; nothing of a single picture.
std::string views_line(const ViewErrors& errors);
/// Makes "views" of result.json.
Json views_json(const ViewErrors& errors);

}  // namespace gnomon::compare
