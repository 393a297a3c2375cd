#include "report/lessons.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>

#include <embedded/lessons.h>

#include "compare/ladder/labels.h"
#include "report/html.h"

namespace gnomon::report {
namespace {

// In the order in which to read them; docs/lessons/README.md has the same.
constexpr std::array<std::string_view, 26> names{
    "shadow-map", "acne",         "peter-panning", "light-leaks",   "aliasing",  "bias",       "precision",
    "filtering",  "soft-shadows", "cascades",      "cube-maps",     "shimmer",   "terminator", "error-budget",
    "not-enough", "ray-casting",  "ray-tracing",   "intersections", "triangles", "boxes",      "grids",
    "structures", "robustness",   "hybrid",        "one-ray",       "cost"};

// What stands between two texts; nothing when they are not there.
std::string_view between(std::string_view text, std::string_view from, std::string_view to) {
  const std::size_t start = text.find(from);
  if (start == std::string_view::npos) return {};
  const std::string_view rest = text.substr(start + from.size());
  return rest.substr(0, rest.find(to));
}

// The section behind "## Goal", without its heading.
std::string_view explanation(std::string_view text) {
  constexpr std::string_view heading = "\n## ";
  const std::size_t goal = text.find(heading), start = text.find(heading, goal + 1);
  assert(goal != std::string_view::npos && start != std::string_view::npos);
  text.remove_prefix(text.find('\n', start + heading.size()));
  return text.substr(0, text.find(heading));
}

Lesson make_lesson(std::string_view name) {
  const std::string_view text = embedded::lessons(fmt::format("{}.md", name));
  return {name, between(text, "# ", "\n"), text, between(text, "```sh\n", "\n")};
}

// Inline Markdown of the lessons: `code`, **strong**, *stressed*.
std::string inline_html(std::string_view text) {
  struct Mark {
    std::string_view mark, tag;
    bool open = false;
  };
  std::array<Mark, 3> marks{{{"**", "b"}, {"*", "em"}, {"`", "code"}}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto mark = std::find_if(marks.begin(), marks.end(),
                                   [&](const Mark& m) { return text.substr(i).starts_with(m.mark); });
    if (mark == marks.end()) {
      out += escaped(text.substr(i++, 1));
      continue;
    }
    out += fmt::format("<{}{}>", mark->open ? "/" : "", mark->tag);
    mark->open = !mark->open;
    i += mark->mark.size();
  }
  return out;
}

}  // namespace

std::span<const Lesson> all_lessons() {
  static const auto lessons = [] {
    std::array<Lesson, names.size()> all;
    std::transform(names.begin(), names.end(), all.begin(), make_lesson);
    return all;
  }();
  return lessons;
}

const Lesson& lesson(std::string_view name) {
  const auto all = all_lessons();
  const auto found =
      std::find_if(all.begin(), all.end(), [name](const Lesson& one) { return one.name == name; });
  assert(found != all.end());
  return *found;
}

const Lesson& lesson_of(compare::Label label) {
  return lesson(compare::label_text(label).lesson);
}

std::string lesson_html(const Lesson& lesson) {
  std::string_view rest = explanation(lesson.text);
  std::string out;
  while (!rest.empty()) {
    rest.remove_prefix(std::min(rest.size(), rest.find_first_not_of('\n')));
    const std::string_view paragraph = rest.substr(0, rest.find("\n\n"));
    rest.remove_prefix(paragraph.size());
    const bool is_figure = paragraph.starts_with("![") || paragraph.starts_with("<!--");
    if (!paragraph.empty() && !is_figure) out += "<p>" + inline_html(paragraph) + "</p>\n";
  }
  return out;
}

}  // namespace gnomon::report
