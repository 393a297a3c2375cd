// What a class was given, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "app/grade/grade.h"

namespace gnomon::app::grade {

std::vector<std::string> page_names_of(const std::vector<StudentResult>& students);

struct ClassResult {
  const Rubric& rubric;
  const std::vector<StudentResult>& students;
  std::string command_line;
  std::vector<std::string> pages =
      page_names_of(students);  ///< the files of the students' pages, in their order
};

/// gnomon/grade/1 (grade.schema.json).
std::string grade_json(const ClassResult& result);
/// One row for each student: name, points, of, and the points of each check; no points stand where nothing was graded.
std::string grade_csv(const ClassResult& result);
/// One paragraph for each student: points, and every check that lost some, with the reason; or why there are none.
std::string grade_table(const ClassResult& result);
/// "17.5 of 20".
std::string points_text(double points, double of);

}  // namespace gnomon::app::grade
