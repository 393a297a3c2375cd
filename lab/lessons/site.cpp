#include "lab/lessons/site.h"

#include <embedded/lectures.h>
#include <embedded/lessons.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/console.h"
#include "lab/lessons/figures.h"
#include "lab/lessons/lecture.h"
#include "lab/lessons/lesson_text.h"
#include "report/html.h"
#include "report/lessons.h"
#include "report/shell.h"
#include "scene/base/option_text.h"
#include "scene/base/stages.h"

namespace gnomon::lab::lessons {

namespace {

using app::Console;

using report::escaped;
using report::Lesson;

using Lessons = std::vector<const Lesson*>;

std::string page_name(const Lesson& lesson) {
  return fmt::format("{}.html", lesson.name);
}

/// The page of a link's target, of those that are written.
std::string page_of(std::string_view target, const Lessons& written) {
  if (target == "README.md") return "index.html";
  const auto found = std::find_if(written.begin(), written.end(), [&](const Lesson* one) {
    return fmt::format("{}.md", one->name) == target;
  });
  return found == written.end() ? std::string() : page_name(**found);
}

Expected<std::string> body_html(std::string_view markdown, const Lessons& written) {
  const auto html = html_of(markdown);
  if (!html) return html;
  return with_pictures(with_links(*html, [&](std::string_view target) { return page_of(target, written); }));
}

/// The language's own words for the English ones (docs/lectures/README.md), which English has no table of.
const nlohmann::ordered_json& figure_words() {
  static const nlohmann::ordered_json words = [] {
    const std::string_view text = embedded::lectures("figures.json");
    return text.empty() ? nlohmann::ordered_json::object() : nlohmann::ordered_json::parse(text);
  }();
  return words;
}
std::string said(const std::string& english) {
  return figure_words().value(english, english);
}

std::string page_html(report::PageShell shell, const PageFigures& figures) {
  nlohmann::ordered_json data = figures.data();
  if (!figure_words().empty()) data["figure_words"] = figure_words();
  shell.data = data.dump();
  shell.parts = figures.parts();
  shell.built = "lesson.html";
  return report::build_page(shell).html;
}

/// A page of a lesson's or a lecture's, in the language of the lessons.
std::string lesson_html(const std::string& title, std::string links, std::string main,
                        const PageFigures& figures, bool computes = false) {
  const std::string skip = said("Skip to the lesson");
  report::PageShell shell;
  shell.title = title + " \u2013 Gnomon";
  shell.links = std::move(links);
  shell.main = std::move(main);
  shell.skip = skip;
  shell.language = GNOMON_LANGUAGE;
  if (computes) shell.live = report::LivePage::worker;
  return page_html(std::move(shell), figures);
}

std::string link(const std::string& page, std::string_view words, std::string_view kind) {
  return fmt::format("<li><a href=\"{}\" rel=\"{}\">{}</a></li>", page, kind, words);
}

std::string link_to_all() {
  return fmt::format("<li><a href=\"index.html\">{}</a></li>", said("All lessons"));
}

/// To the neighbours in the order of reading.
std::string links_of(const Lessons& written, std::size_t at) {
  std::string links = link_to_all();
  if (at > 0) links += link(page_name(*written[at - 1]), said("Previous"), "prev");
  if (at + 1 < written.size()) links += link(page_name(*written[at + 1]), said("Next"), "next");
  return links;
}

/// A page of a text with live figures; `kind`: the class of its article.
Expected<std::string> article_page(const std::string& title, const std::string& links, std::string_view kind,
                                   std::string_view markdown, const Lessons& written, Console& console,
                                   const std::string& lab = {}) {
  const TimedStage stage("page");
  const LessonText text = read_lesson(markdown);
  std::string main = fmt::format("<article class=\"{}\">\n", kind);
  for (const std::string& part : text.parts) {
    const auto html = body_html(part, written);
    if (!html) return html;
    main += "<section class=\"part\">\n" + *html + "</section>\n";
  }
  PageFigures figures(console, lab);
  for (const LiveMark& mark : text.marks)
    if (const auto added = figures.add(mark); !added) return fail(added.error());
  return lesson_html(title, links, main + "</article>\n", figures, !lab.empty());
}

Expected<SitePage> lesson_page(const Lessons& written, std::size_t at, Console& console,
                               const std::string& lab) {
  const Lesson& lesson = *written[at];
  const auto html = article_page(std::string(lesson.title), links_of(written, at), "lesson-text", lesson.text,
                                 written, console, lab);
  if (!html) return fail(html.error());
  return SitePage{page_name(lesson), *html};
}

/// A card with the lesson's picture: "Acne", "the surface shadows itself".
Expected<std::string> card(const Lesson& lesson, std::size_t number) {
  const std::size_t colon = lesson.title.find(": ");
  const std::string_view name = lesson.title.substr(0, colon);
  const std::string_view more = colon == std::string_view::npos ? "" : lesson.title.substr(colon + 2);
  std::string picture = first_picture(lesson.text);
  if (!picture.empty()) {
    const auto html = picture_html(picture, "");
    if (!html) return html;
    picture = *html;
  }
  return fmt::format(
      "<li><a href=\"{}\"><span class=\"card-picture\">{}</span><b>{}. {}</b> <span>{}</span></a></li>\n",
      page_name(lesson), picture, number, report::escaped(name), report::escaped(more));
}

/// What stands in docs/lessons/README.md before its list, and a card for each lesson.
Expected<SitePage> index_page(const Lessons& written) {
  const std::string_view readme = embedded::lessons("README.md");
  const auto before = body_html(readme.substr(0, readme.find("\n1. ")), written);
  if (!before) return fail(before.error());
  std::string main = "<article class=\"lesson-text\">\n" + *before + "</article>\n<ol class=\"cards\">\n";
  for (std::size_t i = 0; i < written.size(); ++i) {
    const auto html = card(*written[i], i + 1);
    if (!html) return fail(html.error());
    main += *html;
  }
  Console quiet(true);
  return SitePage{"index.html",
                  lesson_html(said("Lessons"), link_to_all(), main + "</ol>\n", PageFigures(quiet))};
}

Expected<Lessons> chosen(const std::vector<std::string>& only) {
  Lessons all, some;
  std::vector<std::string_view> names;
  for (const Lesson& lesson : report::all_lessons()) {
    all.push_back(&lesson);
    names.push_back(lesson.name);
  }
  for (const std::string& name : only)
    if (std::find(names.begin(), names.end(), name) == names.end())
      return fail(ErrorKind::usage, fmt::format("--only: no such lesson (got {}, allowed {}){}", name,
                                                fmt::join(names, ", "), did_you_mean(name, names)));
  std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&](const Lesson* lesson) {
    return only.empty() || std::find(only.begin(), only.end(), lesson->name) != only.end();
  });
  return some;
}

}  // namespace

std::string page_of_text(const std::string& title, const std::string& links, const std::string& main) {
  Console quiet(true);
  report::PageShell shell;
  shell.title = title;
  shell.links = links;
  shell.main = main;
  shell.skip = "Skip to the text";
  return page_html(std::move(shell), PageFigures(quiet));
}

Expected<std::vector<SitePage>> make_site(const std::vector<std::string>& only, Console& console,
                                          const std::string& lab) {
  const auto written = chosen(only);
  if (!written) return fail(written.error());
  std::vector<SitePage> pages;
  for (std::size_t i = 0; i < written->size(); ++i) {
    auto page = lesson_page(*written, i, console, lab);
    if (!page) return fail(page.error());
    pages.push_back(std::move(*page));
    console.progress("lessons", static_cast<double>(i + 1) / static_cast<double>(written->size()));
  }
  auto index = index_page(*written);
  if (!index) return fail(index.error());
  pages.push_back(std::move(*index));
  return pages;
}

std::vector<std::string_view> lecture_names() {
  std::vector<std::string_view> names;
  for (const embedded::Entry& deck : embedded::lectures_entries())
    if (deck.name.ends_with(".md")) names.push_back(deck.name.substr(0, deck.name.rfind('.')));
  return names;
}

Expected<SitePage> make_lecture(std::string_view name, Console& console) {
  const std::vector<std::string_view> names = lecture_names();
  if (std::find(names.begin(), names.end(), name) == names.end())
    return fail(ErrorKind::usage, fmt::format("--lecture: no such lecture (got {}, allowed {}){}", name,
                                              fmt::join(names, ", "), did_you_mean(name, names)));
  const std::string_view deck = embedded::lectures(fmt::format("{}.md", name));
  const auto text = lecture_text(deck);
  if (!text) return fail(text.error());
  const std::string title(deck.substr(2, deck.find('\n') - 2));
  const auto html =
      article_page(title, fmt::format("<li><a href=\"#slide-1\">{}</a></li>", said("First slide")), "lecture",
                   *text, {}, console);
  if (!html) return fail(html.error());
  return SitePage{fmt::format("{}.html", name), *html};
}

}  // namespace gnomon::lab::lessons
