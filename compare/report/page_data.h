// What the page's scripts read beside result.json: words, and per light the pixels' numbers, the map and the
// geometry that the probe draws. One JSON text; arrays as in packing.h.
#pragma once

#include <string>

#include "compare/report/page.h"

namespace gnomon::compare {

std::string page_data(const PageInput& input);

}  // namespace gnomon::compare
