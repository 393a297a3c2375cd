#include "grade/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/text_layout.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

using Json = nlohmann::ordered_json;

namespace {

Json points_json(const StudentResult& student, double points) {
  return student.error ? Json(nullptr) : Json(points);
}

std::string points_field(const StudentResult& student, double points) {
  return student.error ? std::string() : fmt::format("{:g}", points);
}

Json student_json(const ClassResult& result, std::size_t index) {
  const StudentResult& student = result.students[index];
  Json checks = Json::array();
  for (std::size_t i = 0; i < student.checks.size(); ++i)
    checks.push_back({{"name", result.rubric.checks[i].name},
                      {"points", points_json(student, student.checks[i].points)},
                      {"of", result.rubric.checks[i].points},
                      {"reason", student.checks[i].reason},
                      {"command", student.checks[i].command}});
  Json json = {{"name", student.name},
               {"page", result.pages[index]},
               {"points", points_json(student, student.points())},
               {"of", result.rubric.points()}};
  if (student.error) json["error"] = student.error->message();
  json["checks"] = std::move(checks);
  return json;
}

Json alike_json(const ClassResult& result) {
  Json pairs = Json::array();
  for (const AlikePair& pair : result.alike)
    pairs.push_back({{"students", {result.students[pair.first].name, result.students[pair.second].name}},
                     {"share", pair.share},
                     {"same_text", pair.same_text}});
  return pairs;
}

/// Whose folder it is that Moodle gave this name: "Ada Lovelace_12345_assignsubmission_file". Of any other the name alone.
std::pair<std::string, std::string> moodle_participant(const std::string& folder) {
  static const std::regex form("(.*)_([0-9]+)_assignsubmission_[a-z]+_?");
  std::smatch found;
  if (!std::regex_match(folder, found, form)) return {"", folder};
  return {"Participant " + found[2].str(), found[1].str()};
}

/// What lost points, and why, in one field.
std::string feedback(const Rubric& rubric, const StudentResult& student) {
  if (student.error) return {};
  std::string text;
  for (std::size_t i = 0; i < student.checks.size(); ++i) {
    const double lost = rubric.checks[i].points - student.checks[i].points;
    if (lost > 0.0)
      text += fmt::format("{}-{:g} {}: {}", text.empty() ? "" : "; ", lost, rubric.checks[i].name,
                          student.checks[i].reason);
  }
  return text;
}

/// The columns of an offline grading worksheet that Moodle reads back (Moodle 4, "Offline grading worksheet").
std::string moodle_csv(const ClassResult& result) {
  std::string text = "Identifier,Full name,Grade,Maximum Grade,Feedback comments\n";
  const auto field = [](const std::string& plain) { return compare::csv_field(compare::csv_name(plain)); };
  for (const StudentResult& student : result.students) {
    const auto [identifier, name] = moodle_participant(student.name);
    text += fmt::format("{},{},{},{:g},{}\n", field(identifier), field(name),
                        points_field(student, student.points()), result.rubric.points(),
                        field(feedback(result.rubric, student)));
  }
  return text;
}

}  // namespace

std::vector<std::string> page_names_of(const std::vector<StudentResult>& students) {
  std::vector<std::string> names;
  for (const StudentResult& student : students) names.push_back(student.name);
  return page_names(names);
}

std::string points_text(double points, double of) {
  return fmt::format("{:g} of {:g}", points, of);
}

std::string grade_json(const ClassResult& result) {
  Json students = Json::array();
  for (std::size_t i = 0; i < result.students.size(); ++i) students.push_back(student_json(result, i));
  Json root = {{"schema", "gnomon/grade/1"},
               {"command", result.command_line},
               {"version", compare::program_version()},
               {"rubric", result.rubric.title}};
  if (!result.rubric.technique.empty()) root["technique"] = result.rubric.technique;
  root["students"] = std::move(students);
  root["alike"] = alike_json(result);
  return plain_lines(root.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::string grade_csv(const ClassResult& result) {
  std::string text = "student,points,of";
  for (const Check& check : result.rubric.checks)
    text += fmt::format(",{}", compare::csv_field(compare::csv_name(check.name)));
  text += "\n";
  for (const StudentResult& student : result.students) {
    text += fmt::format("{},{},{:g}", compare::csv_field(compare::csv_name(student.name)),
                        points_field(student, student.points()), result.rubric.points());
    for (const CheckResult& check : student.checks) text += "," + points_field(student, check.points);
    text += "\n";
  }
  return text;
}

std::string grade_csv(const ClassResult& result, CsvForm form) {
  return form == CsvForm::moodle ? moodle_csv(result) : grade_csv(result);
}

std::string alike_words(const ClassResult& result, const AlikePair& pair) {
  return fmt::format("{} and {}: {}", one_line(result.students[pair.first].name),
                     one_line(result.students[pair.second].name),
                     pair.same_text ? "the very same text"
                                    : compare::percent(pair.share) + " of what is their own, names aside");
}

namespace {

/// A reason that stands right above is not said again.
std::string lost_points(const Rubric& rubric, const StudentResult& student) {
  std::string text, above;
  for (std::size_t i = 0; i < student.checks.size(); ++i) {
    const double lost = rubric.checks[i].points - student.checks[i].points;
    if (lost <= 0.0) continue;
    const std::string& reason = student.checks[i].reason;
    text += fmt::format("  -{:g}  {}: {}\n", lost, one_line(rubric.checks[i].name),
                        reason == above ? "the same" : one_line(reason));
    above = reason;
  }
  return text;
}

}  // namespace

std::string grade_table(const ClassResult& result) {
  std::size_t width = 0;
  for (const StudentResult& student : result.students) width = std::max(width, one_line(student.name).size());
  std::string text;
  for (const StudentResult& student : result.students) {
    const std::string name = one_line(student.name);
    if (student.error) {
      text += fmt::format("{:<{}}  not graded: {}\n", name, width, one_line(student.error->message()));
      continue;
    }
    text += fmt::format("{:<{}}  {}\n", name, width, points_text(student.points(), result.rubric.points()));
    text += lost_points(result.rubric, student);
  }
  if (!result.alike.empty()) text += "\nAnswers that are alike (look at them before you ask):\n";
  for (const AlikePair& pair : result.alike) text += "  " + alike_words(result, pair) + "\n";
  return text;
}

}  // namespace gnomon::grade
