// The report page: one HTML file that needs nothing but itself. The pieces are written in C++ (sections,
// charts) around report.css and report.js, which are embedded; every number on the page carries its key in
// result.json
// (<data data-key="lights.0.error.wrong">), which the browser test compares.
#pragma once

#include <string>
#include <string_view>

#include "compare/comparison.h"
#include "compare/picture_set.h"

namespace gnomon::compare {

struct PageInput {
  const Comparison& comparison;
  const PictureSet& pictures;
  std::string_view json;  ///< result.json's text, embedded in the page and offered for saving
  std::string_view csv;
  double total_ms = 0.0;
};

/// The whole page.
std::string report_page(const PageInput& input);

}  // namespace gnomon::compare
