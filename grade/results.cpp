#include "grade/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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
  for (std::size_t i = 0; i < student.checks.size(); ++i) {
    checks.push_back({{"name", result.rubric.checks[i].name},
                      {"points", points_json(student, student.checks[i].points)},
                      {"of", result.rubric.checks[i].points},
                      {"reason", student.checks[i].reason},
                      {"command", student.checks[i].command}});
    if (!student.checks[i].mistake.empty()) checks.back()["mistake"] = student.checks[i].mistake;
  }
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

Json common_json(const ClassResult& result) {
  Json losses = Json::array();
  for (const CommonLoss& loss : common_losses(result)) {
    Json names = Json::array();
    for (const std::size_t student : loss.students) names.push_back(result.students[student].name);
    losses.push_back(
        {{"words", loss.words}, {"is_mistake", loss.is_mistake}, {"students", std::move(names)}});
  }
  return losses;
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

std::string field(const std::string& plain) {
  return compare::csv_field(compare::csv_name(plain));
}

/// The columns of an offline grading worksheet that Moodle reads back (Moodle 4, "Offline grading worksheet"). A name is as it is there.
std::string moodle_csv(const ClassResult& result) {
  std::string text = "Identifier,Full name,Grade,Maximum Grade,Feedback comments\n";
  for (const StudentResult& student : result.students) {
    const bool known = student.participant.platform == Platform::moodle;
    text += fmt::format("{},{},{},{:g},{}\n", known ? field("Participant " + student.participant.id) : "",
                        compare::csv_field(known ? student.participant.name : student.name),
                        points_field(student, student.points()), result.rubric.points(),
                        field(feedback(result.rubric, student)));
  }
  return text;
}

/// The columns of a gradebook that Canvas reads in ("Upload Scores"): students are told apart by their ID, the assignment by its title.
std::string canvas_csv(const ClassResult& result) {
  std::string text =
      fmt::format("Student,ID,SIS User ID,SIS Login ID,Section,{}\n    Points Possible,,,,,{:g}\n",
                  field(result.rubric.title), result.rubric.points());
  for (const StudentResult& student : result.students) {
    const bool known = student.participant.platform == Platform::canvas;
    text += fmt::format("{},{},,,,{}\n", compare::csv_field(known ? student.participant.name : student.name),
                        known ? student.participant.id : "", points_field(student, student.points()));
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
  root["common"] = common_json(result);
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
  if (form == CsvForm::moodle) return moodle_csv(result);
  return form == CsvForm::canvas ? canvas_csv(result) : grade_csv(result);
}

std::string alike_words(const ClassResult& result, const AlikeGroup& group) {
  std::string names;
  for (std::size_t i = 0; i < group.students.size(); ++i)
    names += (i == 0                           ? ""
              : i + 1 == group.students.size() ? " and "
                                               : ", ") +
             one_line(result.students[group.students[i]].name);
  return fmt::format("{}: {}", names,
                     group.same_text
                         ? "the very same text"
                         : fmt::format("{}{} of what is their own, names aside",
                                       group.students.size() > 2 && group.share < 1.0 ? "at least " : "",
                                       compare::percent(group.share)));
}

std::vector<CommonLoss> common_losses(const ClassResult& result) {
  std::vector<CommonLoss> all;
  const auto add = [&](const std::string& words, bool is_mistake, std::size_t student) {
    const auto is_it = [&](const CommonLoss& loss) {
      return loss.words == words && loss.is_mistake == is_mistake;
    };
    const auto known = std::ranges::find_if(all, is_it);
    CommonLoss& loss = known != all.end() ? *known : all.emplace_back(CommonLoss{words, is_mistake, {}});
    if (loss.students.empty() || loss.students.back() != student) loss.students.push_back(student);
  };
  for (std::size_t i = 0; i < result.students.size(); ++i) {
    const StudentResult& student = result.students[i];
    for (std::size_t k = 0; k < student.checks.size() && !student.error; ++k) {
      const Check& check = result.rubric.checks[k];
      const std::string& mistake = student.checks[k].mistake;
      const std::string function = check.runs.empty() ? std::string() : check.runs.front().function;
      if (!mistake.empty())
        add(fmt::format("{} as if {}", function.empty() ? "drawn" : function, mistake), true, i);
      else if (student.checks[k].points < check.points)
        add(check.name, false, i);
    }
  }
  std::erase_if(all, [](const CommonLoss& loss) { return loss.students.size() < 2; });
  std::ranges::stable_sort(all, [](const CommonLoss& a, const CommonLoss& b) {
    return a.is_mistake != b.is_mistake ? a.is_mistake : a.students.size() > b.students.size();
  });
  return all;
}

std::string loss_words(const ClassResult& result, const CommonLoss& loss) {
  return fmt::format("{} of {}{}: {}", loss.students.size(), result.students.size(),
                     loss.is_mistake ? "" : " without all points of", one_line(loss.words));
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
  const std::vector<CommonLoss> losses = common_losses(result);
  if (!losses.empty()) text += "\nWhat to say next time:\n";
  for (const CommonLoss& loss : losses) text += "  " + loss_words(result, loss) + "\n";
  if (!result.alike.empty()) text += "\nAnswers that are alike (look at them before you ask):\n";
  for (const AlikeGroup& group : groups_of(result.alike)) text += "  " + alike_words(result, group) + "\n";
  return text;
}

}  // namespace gnomon::grade
