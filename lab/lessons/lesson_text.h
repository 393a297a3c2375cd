// A lesson's Markdown (docs/lessons), taken apart for the site: the parts that make a slide each, and the marks of
// live figures. In the text a mark is a comment on a line of its own before the picture that it replaces:
//
//   <!-- live: bias scene=acne-floor map-size=64 -->
//   ![Acne on a floor](../images/lesson-acne.png)
//
// so that the same file is a page for readers of Markdown. A part begins at each "## ", and at "<!-- slide -->".
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon::lab::lessons {

/// A live figure as the text asks for it.
struct LiveMark {
  std::string name;                                           ///< "bias"
  std::vector<std::pair<std::string, std::string>> settings;  ///< {"scene", "acne-floor"}, in their order
  /// Empty where it is not given.
  std::string setting(std::string_view key) const;
};

/// Reads what stands in a mark, such as "bias scene=acne-floor map-size=64".
LiveMark read_mark(std::string_view text);

struct LessonText {
  std::vector<std::string> parts;  ///< Markdown; each mark is a <div class="live" data-figure="N">
  std::vector<LiveMark> marks;     ///< by N
};

LessonText read_lesson(std::string_view markdown);

}  // namespace gnomon::lab::lessons
