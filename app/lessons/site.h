// The lessons as a site: a page for each lesson, and index.html. Every page is one file that needs nothing but
// itself: style, script, pictures and the data of its live figures are in it (compare/report/shell.h), so that the
// site works from disk, and a single lesson can be handed on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/expected.h"

namespace gnomon::app::lessons {

struct SitePage {
  std::string file;  ///< "acne.html"
  std::string html;
};

/// The pages of the lessons of those names, all of them where there are none, and the index of these.
/// `done` is told the share. Error (usage): a name that no lesson has.
Expected<std::vector<SitePage>> make_site(const std::vector<std::string>& only,
                                          const std::function<void(double)>& done);

}  // namespace gnomon::app::lessons
