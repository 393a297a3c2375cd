// The lessons as a site: a page for each lesson, and index.html. Every page is one file that needs nothing but
// itself: style, script, pictures and the data of its live figures are in it (report/shell.h), so that the
// site works from disk, and a single lesson can be handed on.
#pragma once

#include <string>
#include <vector>

#include "scene/expected.h"

namespace gnomon::app {
class Console;
}

namespace gnomon::app::lessons {

struct SitePage {
  std::string file;  ///< "acne.html"
  std::string html;
};

/// The pages of the lessons of those names, all of them where there are none, and the index of these.
/// Errors: (usage) a name that no lesson has; those of a live figure's scene, of its settings, of the graphics.
Expected<std::vector<SitePage>> make_site(const std::vector<std::string>& only, Console& console);

}  // namespace gnomon::app::lessons
