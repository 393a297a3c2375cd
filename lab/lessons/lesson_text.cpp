#include "lab/lessons/lesson_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

namespace gnomon::lab::lessons {

namespace {

constexpr std::string_view live_opening = "<!-- live: ", comment_closing = " -->",
                           slide_mark = "<!-- slide -->";

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool is_live(std::string_view line) {
  return line.starts_with(live_opening) && line.ends_with(comment_closing);
}

}  // namespace

LiveMark read_mark(std::string_view text) {
  std::istringstream words{std::string(text)};
  LiveMark mark;
  words >> mark.name;
  for (std::string word; words >> word;) {
    const std::size_t equals = std::min(word.find('='), word.size());
    mark.settings.emplace_back(word.substr(0, equals), word.substr(std::min(equals + 1, word.size())));
  }
  return mark;
}

std::string LiveMark::setting(std::string_view key) const {
  const auto found =
      std::find_if(settings.begin(), settings.end(), [&](const auto& s) { return s.first == key; });
  return found == settings.end() ? std::string() : found->second;
}

LessonText read_lesson(std::string_view markdown) {
  LessonText text{{""}, {}};
  bool in_code = false, wants_picture = false;
  const auto add = [&](std::string_view line) { text.parts.back().append(line).append("\n"); };
  const auto close_figure = [&] {
    if (wants_picture) add("\n</div>\n");
    wants_picture = false;
  };
  for (const std::string& line : lines_of(markdown)) {
    if (line.starts_with("```")) in_code = !in_code;
    if (!in_code && (line.starts_with("## ") || line == slide_mark)) {
      close_figure();
      text.parts.emplace_back();
      if (line == slide_mark) continue;
    }
    if (!in_code && is_live(line)) {
      close_figure();
      add(fmt::format("\n<div class=\"live\" data-figure=\"{}\">\n", text.marks.size()));
      text.marks.push_back(read_mark(std::string_view(line).substr(
          live_opening.size(), line.size() - live_opening.size() - comment_closing.size())));
      wants_picture = true;
      continue;
    }
    // The picture, or whatever else stands there: then there is none.
    const bool is_picture = line.starts_with("![");
    if (wants_picture && !line.empty() && !is_picture) close_figure();
    add(line);
    if (is_picture) close_figure();
  }
  close_figure();
  return text;
}

}  // namespace gnomon::lab::lessons
