// A setting judged from several views: which of them errs most, and how that is said.
#pragma once

#include <string>

#include "compare/comparison.h"
#include "compare/result/result_parts.h"

namespace gnomon::compare {

/// Adds what the comparison's lights err by from there, the worst of them. Whether no view before errs more.
bool add_view(ViewErrors& errors, std::string name, const Comparison& comparison);

/// The mean over the views in which something is compared; NaN where there is none.
double mean_error(const ViewErrors& errors);

/// "Worst of 5 views: kitchen, 6.1 % (2.0 % in the mean)."; empty of a single picture.
std::string views_line(const ViewErrors& errors);
/// "views" of result.json.
Json views_json(const ViewErrors& errors);

}  // namespace gnomon::compare
