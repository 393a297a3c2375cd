#include "grade/results.h"

#include <embedded/grade_page.h>
#include <fmt/core.h>

#include <sstream>
#include <utility>

#include "compare/ladder/labels.h"
#include "compare/result/outputs.h"
#include "report/html.h"
#include "scene/files/path_status.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::grade {

namespace {

using report::escaped;
using report::flowing;

std::string page(const std::string& title, const std::string& body) {
  const std::string style = fmt::format("\n{}", embedded::grade_page("page.css"));
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{}\n<style>{}</style>\n"
      "</head>\n<body>\n{}</body>\n</html>\n",
      report::page_head({title, style}), style, body);
}

// "[A] acne, [D] peter-panning"
std::string key_html(const std::vector<compare::Label>& labels) {
  std::string html;
  for (const compare::Label label : labels) {
    const compare::LabelText& text = compare::label_text(label);
    html += fmt::format("{}<span class=\"key\">{} {}</span>", html.empty() ? ": " : ", ",
                        report::swatch(compare::label_colour(label), text.letter), text.name);
  }
  return html;
}

std::string figures_html(const CheckResult& result) {
  if (result.pictures.empty()) return {};
  std::string html = "<div class=\"pictures\">\n";
  for (const Picture& picture : result.pictures)
    html += fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}{}</figcaption></figure>\n",
                        report::data_uri("image/png", picture.png), escaped(picture.caption),
                        escaped(picture.caption), key_html(picture.labels));
  return html + "</div>\n";
}

std::string excerpt_html(const std::string& excerpt) {
  if (excerpt.empty()) return {};
  std::string html = "<pre>";
  std::istringstream lines(excerpt);
  for (std::string line; std::getline(lines, line);) html += escaped(line) + "\n";
  return html + "</pre>\n";
}

/// The rubric's own words, which may be of another language than the page's.
std::string in_its_language(const Rubric& rubric, const std::string& html) {
  if (rubric.language == "en") return html;
  return fmt::format("<span lang=\"{}\">{}</span>", escaped(rubric.language), html);
}

std::string check_html(const Rubric& rubric, const Check& check, const CheckResult& result) {
  const bool full = result.points >= check.points;
  std::string html =
      fmt::format("<article>\n<header><h2>{}</h2><span class=\"{}\">{}</span></header>\n<p>{}</p>\n",
                  in_its_language(rubric, escaped(check.name)), full ? "full" : "lost",
                  points_text(result.points, check.points), flowing(result.reason));
  if (full) return html + "</article>\n";
  html += excerpt_html(result.excerpt);
  html += figures_html(result);
  if (!check.hint.empty() && !result.command.empty())
    html += fmt::format("<p>{}</p>\n", in_its_language(rubric, flowing(check.hint)));
  if (!result.command.empty())
    html += fmt::format("<p class=\"quiet\">See it yourself: <code>{}</code></p>\n", escaped(result.command));
  return html + "</article>\n";
}

std::string points_cell(const StudentResult& student, double points, std::string_view style) {
  if (student.error) return "<td class=\"lost\">not graded</td>";
  return fmt::format("<td class=\"{}\">{:g}</td>", style, points);
}

std::string class_row(const ClassResult& result, std::size_t index) {
  const StudentResult& student = result.students[index];
  std::string row =
      fmt::format("<tr><th scope=\"row\"><a href=\"{}\">{}</a></th>{}", escaped(result.pages[index]),
                  escaped(student.name), points_cell(student, student.points(), ""));
  for (std::size_t i = 0; i < student.checks.size(); ++i)
    row += points_cell(student, student.checks[i].points,
                       student.checks[i].points < result.rubric.checks[i].points ? "lost" : "full");
  return row + "</tr>\n";
}

/// What the next lesson may begin with.
std::string common_html(const ClassResult& result) {
  std::string items;
  for (const CommonLoss& loss : common_losses(result))
    items += fmt::format("<li>{}</li>\n", flowing(loss_words(result, loss)));
  return items.empty() ? items : fmt::format("<h2>What to say next time</h2>\n<ul>\n{}</ul>\n", items);
}

/// Where a platform takes a student's page back: a folder of Moodle's and Brightspace's name, a file of the name that others gave.
std::string feedback_place(const Participant& participant) {
  constexpr std::size_t longest = 250;  // bytes of a file's name, with room for its ending
  if (participant.platform == Platform::none) return {};
  const std::string name = participant.returned_as.substr(0, longest);
  const bool is_folder = participant.platform == Platform::moodle || participant.file.empty();
  return is_folder ? fmt::format("feedback/{}/feedback.html", name) : fmt::format("feedback/{}.html", name);
}

std::string alike_html(const ClassResult& result) {
  if (result.alike.empty()) return {};
  std::string html =
      "<h2>Answers that are alike</h2>\n<p>Names, layout and comments do not count, nor what the exercise "
      "gives. "
      "Short right answers can be alike by themselves: look at both before you ask.</p>\n<ul>\n";
  for (const AlikeGroup& group : groups_of(result.alike))
    html += fmt::format("<li>{}</li>\n", flowing(alike_words(result, group)));
  return html + "</ul>\n";
}

}  // namespace

std::string student_page(const Rubric& rubric, const StudentResult& student) {
  std::string body =
      fmt::format("<main>\n<h1>{}: {}</h1>\n<p class=\"sum\">{}</p>\n", escaped(student.name),
                  in_its_language(rubric, escaped(rubric.title)),
                  student.error ? "not graded" : points_text(student.points(), rubric.points()) + " points");
  if (student.error)
    return page(student.name + ": " + rubric.title,
                body + fmt::format("<p>{}</p>\n</main>\n", flowing(student.error->message())));
  if (!rubric.text.empty()) body += fmt::format("<p>{}</p>\n", in_its_language(rubric, flowing(rubric.text)));
  for (std::size_t i = 0; i < student.checks.size(); ++i)
    body += check_html(rubric, rubric.checks[i], student.checks[i]);
  return page(student.name + ": " + rubric.title, body + "</main>\n");
}

std::string class_page(const ClassResult& result) {
  std::string body = fmt::format(
      "<main>\n<h1>{}</h1>\n<p>{:g} points in all. A student's name opens the page to hand "
      "out.</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"Points\">\n<table>\n<thead><tr><th scope=\"col\">Student</th><th "
      "scope=\"col\">Points</th>",
      in_its_language(result.rubric, escaped(result.rubric.title)), result.rubric.points());
  for (const Check& check : result.rubric.checks)
    body += fmt::format("<th scope=\"col\">{} <span class=\"quiet\">({:g})</span></th>",
                        in_its_language(result.rubric, escaped(check.name)), check.points);
  body += "</tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < result.students.size(); ++i) body += class_row(result, i);
  body += "</tbody>\n</table>\n</div>\n" + common_html(result) + alike_html(result);
  body +=
      fmt::format("<p class=\"quiet\">Made by <code>{}</code></p>\n</main>\n", escaped(result.command_line));
  return page(result.rubric.title, body);
}

Expected<void> check_pages(const std::string& folder, const std::vector<std::string>& pages) {
  for (const std::string& page : pages) {
    const std::string path = fmt::format("{}/{}", folder, page);
    const auto kind = file_kind(path, ErrorKind::cannot_write);
    if (!kind) return fail(kind.error());
    if (*kind == FileKind::folder) return fail(Error{ErrorKind::cannot_write, "is a folder", path});
  }
  return {};
}

Expected<void> write_pages(const ClassResult& result, const std::string& folder,
                           const std::vector<std::string>& inputs, std::span<const FileText> elsewhere) {
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  std::vector<std::pair<std::string, std::string>> files = {{"grades.json", grade_json(result)},
                                                            {"grades.csv", grade_csv(result)},
                                                            {"index.html", class_page(result)}};
  for (std::size_t i = 0; i < result.students.size(); ++i)
    files.emplace_back(result.pages[i], student_page(result.rubric, result.students[i]));
  for (std::size_t i = 0; i < result.students.size(); ++i)
    if (std::string place = feedback_place(result.students[i].participant); !place.empty())
      files.emplace_back(std::move(place), student_page(result.rubric, result.students[i]));
  for (const auto& [name, text] : files) {
    const std::string path = staged->path() + "/" + name;
    if (const auto made = make_folder_for(path); !made) return made;
    if (auto written = write_file(path, text); !written) return written;
  }
  StagedFiles also;
  return also.publish(*staged, "index.html", inputs, elsewhere);
}

}  // namespace gnomon::grade
