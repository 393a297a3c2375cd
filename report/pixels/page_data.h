// What the page's scripts read beside result.json: words, and per light the pixels' numbers, the map and the
// geometry that the probe draws. JSON texts; arrays as in packing.h.
#pragma once

#include <string>

#include "report/page.h"

namespace gnomon::compare {

/// The large parts apart, so that they may stand in files of their own: "pixels" (what both renderers see and
/// their linear pictures), "geometry", and "light-0", "light-1", …
struct PageData {
  std::string head;
  std::vector<DataPart> parts;
};
PageData page_data(const PageInput& input);

}  // namespace gnomon::compare
