// Pages to hand out: one for each student, and a table of the class. They need no server and no network.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "app/grade/results.h"
#include "scene/expected.h"

namespace gnomon::app::grade {

std::string student_page(const Rubric& rubric, const StudentResult& student);
std::string class_page(const ClassResult& result);
/// What write_pages() always writes.
inline constexpr std::array<std::string_view, 3> class_file_names{"index.html", "grades.json", "grades.csv"};
/// Before anything is drawn: whether these pages can be put there. ErrorKind::cannot_write.
Expected<void> check_pages(const std::string& folder, const std::vector<std::string>& pages);
/// Those, and every student's page: all of them appear, or none. Errors: ErrorKind::usage where one would take the place of
/// one of `inputs`, ErrorKind::cannot_write.
Expected<void> write_pages(const ClassResult& result, const std::string& folder,
                           const std::vector<std::string>& inputs);

}  // namespace gnomon::app::grade
