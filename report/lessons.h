// The lessons (docs/lessons), embedded. A lesson begins with its goal ("## Goal"); the section behind that explains, and
// is its short form, which the report page carries; a figure in it is left to the manual.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "compare/comparison.h"

namespace gnomon::report {

struct Lesson {
  std::string_view name;     ///< "peter-panning": docs/lessons/peter-panning.md
  std::string_view title;    ///< "Peter-panning: the shadow comes loose"
  std::string_view text;     ///< Markdown, the whole of it
  std::string_view command;  ///< the first one that it gives: "gnomon compare floating-box --bias 0.3"
};

/// All lessons, in the order in which to read them.
std::span<const Lesson> all_lessons();
/// The lesson of that name, which must exist.
const Lesson& lesson(std::string_view name);
/// The lesson that explains a wrong pixel.
const Lesson& lesson_of(compare::Label label);

/// The short form as HTML paragraphs.
std::string lesson_html(const Lesson& lesson);
}  // namespace gnomon::report
