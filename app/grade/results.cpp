#include "app/grade/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/csv_field.h"
#include "compare/option_names.h"
#include "scene/one_line.h"

namespace gnomon::app::grade {

using Json = nlohmann::ordered_json;

std::string points_text(double points, double of) {
  return fmt::format("{:g} of {:g}", points, of);
}

std::string grade_json(const ClassResult& result) {
  Json students = Json::array();
  for (const StudentResult& student : result.students) {
    Json checks = Json::array();
    for (std::size_t i = 0; i < student.checks.size(); ++i)
      checks.push_back({{"name", result.rubric.checks[i].name},
                        {"points", student.checks[i].points},
                        {"of", result.rubric.checks[i].points},
                        {"reason", student.checks[i].reason},
                        {"command", student.checks[i].command}});
    students.push_back({{"name", student.name},
                        {"points", student.points()},
                        {"of", result.rubric.points()},
                        {"checks", std::move(checks)}});
  }
  const Json root = {{"schema", "gnomon/grade/1"},
                     {"command", result.command_line},
                     {"version", compare::program_version()},
                     {"rubric", result.rubric.title},
                     {"technique", result.rubric.technique},
                     {"students", std::move(students)}};
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string grade_csv(const ClassResult& result) {
  std::string text = "student,points,of";
  for (const Check& check : result.rubric.checks)
    text += fmt::format(",{}", compare::csv_field(compare::csv_name(check.name)));
  text += "\n";
  for (const StudentResult& student : result.students) {
    text += fmt::format("{},{:g},{:g}", compare::csv_field(compare::csv_name(student.name)), student.points(),
                        result.rubric.points());
    for (const CheckResult& check : student.checks) text += fmt::format(",{:g}", check.points);
    text += "\n";
  }
  return text;
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
    text += fmt::format("{:<{}}  {}\n", one_line(student.name), width,
                        points_text(student.points(), result.rubric.points()));
    text += lost_points(result.rubric, student);
  }
  return text;
}

}  // namespace gnomon::app::grade
