#include "lab/lessons/lecture.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "lab/lessons/lesson_text.h"
#include "report/lessons.h"

namespace gnomon::lab::lessons {

namespace {

/// Stretches of text between empty lines. A question is one, with its answer, and so is code between fences.
std::vector<std::string> blocks_of(std::string_view markdown) {
  std::vector<std::string> blocks{""};
  std::istringstream stream{std::string(markdown)};
  bool in_code = false, in_question = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("```")) in_code = !in_code;
    if (line.starts_with("<details>")) in_question = true;
    if (line.empty() && !in_code && !in_question) {
      if (!blocks.back().empty()) blocks.emplace_back();
      continue;
    }
    blocks.back() += line + "\n";
    if (line == "</details>") in_question = false;
  }
  return blocks;
}

bool is_figure(std::string_view block) {
  return block.starts_with("<!-- live: ") || block.starts_with("![");
}

bool is_text(std::string_view block) {
  return !block.starts_with("```") && !block.starts_with("    ") && !block.starts_with("|") &&
         !block.starts_with("<") && !block.starts_with("#") && !is_figure(block);
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// A slide leads nowhere: "[acne](acne.md)" is "acne".
std::string without_links(std::string text) {
  for (std::size_t middle = text.find("]("); middle != std::string::npos; middle = text.find("](", middle)) {
    const std::size_t open = text.rfind('[', middle), close = text.find(')', middle);
    if (open == std::string::npos || close == std::string::npos) break;
    text.erase(middle, close - middle + 1).erase(open, 1);
  }
  return text;
}

/// Where the sentence that begins at `start` ends.
std::size_t sentence_end(std::string_view text, std::size_t start) {
  for (std::size_t at = text.find_first_of(".?!", start); at != std::string_view::npos;
       at = text.find_first_of(".?!", at + 1)) {
    std::size_t after = at + 1;
    while (after < text.size() && (text[after] == '*' || text[after] == ')')) ++after;
    if (after >= text.size() || text[after] == ' ') return after;
  }
  return text.size();
}

bool begins_sentence(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  return before.find_first_not_of("- 0123456789.") == std::string_view::npos ||
         (before.ends_with(' ') && before.find_last_of(".?!:*)") + 2 == at);
}

std::string sentence_in(const std::string& block, std::string_view words) {
  const std::string text = one_line(block);
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
    std::size_t start = at;
    while (start > 0 && text[start - 1] == '*') --start;  // of **strong** words
    if (begins_sentence(text, start))
      return without_links(text.substr(start, sentence_end(text, at) - start)) + "\n";
  }
  return {};
}

/// The mark of the block with other settings, "map-size=32 bias=0".
std::string with_settings(std::string block, std::string_view settings) {
  const std::size_t end = block.find(" -->");
  if (settings.empty() || end == std::string::npos) return block;
  std::istringstream stream{std::string(settings)};
  std::string added;
  for (std::string setting; stream >> setting;) {
    const std::string key = fmt::format(" {}", setting.substr(0, setting.find('=') + 1));
    const std::size_t old = block.find(key);
    if (old == std::string::npos || old > block.find(" -->")) {
      added += " " + setting;
    } else {
      block.replace(old + 1, std::min(block.find(' ', old + 1), block.find(" -->")) - old - 1, setting);
    }
  }
  return block.insert(block.find(" -->"), added);
}

/// "<details><summary>Q</summary> A </details>" as a bold question and its answer, a line of "===" between them.
std::string question_of(std::string_view block, std::string_view words) {
  constexpr std::string_view opening = "<details><summary>", middle = "</summary>";
  if (!block.starts_with(opening) || !block.substr(opening.size()).starts_with(words)) return {};
  const std::size_t end = block.find(middle);
  const std::string_view question = block.substr(opening.size(), end - opening.size());
  const std::string_view answer =
      block.substr(end + middle.size(), block.rfind("</details>") - end - middle.size());
  return fmt::format("**{}**\n\n===\n{}", question, without_links(std::string(answer)));
}

std::string part_in(const std::string& block, std::string_view kind, std::string_view words) {
  if (kind == "sentence") return is_text(block) ? sentence_in(block, words) : "";
  if (kind == "question") return question_of(block, words);
  if (kind == "formula")
    return block.starts_with("    ") && std::string_view(block).substr(4).starts_with(words) ? block : "";
  if (kind == "code") {
    const bool here = block.starts_with("<!-- code: ") && block.find(words) < block.find('\n');
    return here ? block.substr(block.find('\n') + 1) : "";
  }
  if (kind == "table") return block.starts_with("|") && block.starts_with(words) ? without_links(block) : "";
  const std::size_t with = words.find(" with ");
  const bool here = is_figure(block) && block.find(words.substr(0, with)) != std::string::npos;
  return here ? with_settings(block, with == std::string_view::npos ? "" : words.substr(with + 6)) : "";
}

Error not_there(std::string_view what) {
  return {ErrorKind::internal, fmt::format("a lecture shows what no lesson has (got {})", what)};
}

std::string step(std::string_view kind, std::string_view markdown) {
  return fmt::format("<div class=\"step {}\">\n\n{}\n</div>\n\n", kind, markdown);
}

/// "acne figure bias with map-size=32": the part, in the steps that show it. "cascades pair lesson-cascades.png" is a figure of two
/// pictures side by side. The slide shows the left one first and then the right one in its place, as large.
Expected<std::string> steps_of(std::string_view shown) {
  const std::size_t first = shown.find(' '), second = shown.find(' ', first + 1);
  if (second == std::string_view::npos) return fail(not_there(shown));
  const std::string_view name = shown.substr(0, first), kind = shown.substr(first + 1, second - first - 1);
  const auto all = report::all_lessons();
  const auto lesson =
      std::find_if(all.begin(), all.end(), [&](const report::Lesson& one) { return one.name == name; });
  if (lesson == all.end()) return fail(not_there(shown));
  const bool is_pair = kind == "pair";
  const auto part = lesson_part(lesson->text, is_pair ? "figure" : kind, shown.substr(second + 1));
  if (!part) return fail(not_there(shown));
  if (is_pair) return step("figure pair", *part) + step("flip", "");
  if (kind != "question") return step(kind, *part);
  const std::size_t answer = part->find("===\n");
  return step("question", part->substr(0, answer)) + step("sentence", part->substr(answer + 4));
}

/// What is between `opening` and " -->" of a line that is such a comment; else nothing.
std::string_view comment(std::string_view line, std::string_view opening) {
  constexpr std::string_view closing = " -->";
  if (!line.starts_with(opening) || !line.ends_with(closing)) return {};
  line.remove_prefix(opening.size());
  line.remove_suffix(closing.size());
  return line;
}

constexpr std::string_view beyond_mark = "<!-- beyond -->";

struct Slide {
  std::string heading, steps, minutes, notes;
  bool beyond = false;  ///< may be left out
};

Expected<std::string> slide_text(const Slide& slide) {
  if (slide.minutes.empty())
    return fail(ErrorKind::internal, fmt::format("a slide has no minutes (got {})", slide.heading));
  return fmt::format("{}\n\n{}<aside class=\"notes\" data-minutes=\"{}\"{}>\n\n{}\n</aside>\n\n",
                     slide.heading, slide.steps, slide.minutes, slide.beyond ? " data-beyond=\"\"" : "",
                     slide.notes);
}

}  // namespace

Expected<std::string> lesson_part(std::string_view markdown, std::string_view kind, std::string_view words) {
  for (const std::string& block : blocks_of(markdown))
    if (std::string part = part_in(block, kind, words); !part.empty()) return part;
  return fail(not_there(words));
}

Expected<std::string> lecture_text(std::string_view deck) {
  std::string text;
  Slide slide;
  const auto close = [&]() -> Expected<void> {
    const auto made = slide_text(slide);
    if (!made) return fail(made.error());
    text += *made;
    return {};
  };
  for (const std::string& block : blocks_of(deck)) {
    if (block.starts_with("## "))
      if (const auto closed = close(); !closed) return fail(closed.error());
    if (block.starts_with("#")) slide = {block, "", "", "", false};
    if (block.starts_with("> ")) slide.steps += step("sentence", block.substr(2));
    if (block.starts_with("#") || block.starts_with("> ")) continue;
    std::istringstream lines(block);
    for (std::string line; std::getline(lines, line);) {
      const std::string_view minutes = comment(line, "<!-- minutes: "), shown = comment(line, "<!-- show: ");
      if (!minutes.empty()) slide.minutes = minutes;
      if (line == beyond_mark) {
        slide.beyond = true;
        continue;
      }
      if (!shown.empty()) {
        const auto steps = steps_of(shown);
        if (!steps) return fail(steps.error());
        slide.steps += *steps;
      }
      if (minutes.empty() && shown.empty()) slide.notes += line + "\n";
    }
    slide.notes += "\n";
  }
  if (const auto closed = close(); !closed) return fail(closed.error());
  return text;
}

}  // namespace gnomon::lab::lessons
