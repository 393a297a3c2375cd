// The report page: one HTML file that needs nothing but itself. What can be read without scripts is written
// in C++ (sections, charts) into page/dist/page.html, the built and embedded style and script (TypeScript in
// page/); page_data.h adds what the scripts read. Every number on the page carries its key in result.json
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

/// The content-security policy of a page with this style and script, each in one inline block: nothing may be
/// loaded, sent or run but these and the page's own images.
std::string page_security_policy(std::string_view style, std::string_view script);

/// The style of the built page, for other pages to share.
std::string_view page_style();

/// The whole page.
std::string report_page(const PageInput& input);

}  // namespace gnomon::compare
