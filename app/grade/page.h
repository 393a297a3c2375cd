// Pages to hand out: one for each student, and a table of the class. They need no server and no network.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "app/grade/results.h"
#include "scene/expected.h"

namespace gnomon::app::grade {

std::string student_page(const Rubric& rubric, const StudentResult& student);
std::string class_page(const ClassResult& result);
/// The student's page as a file's name, "anna.html".
std::string page_name(const StudentResult& student);

/// What write_pages() always writes.
inline constexpr std::array<std::string_view, 3> class_file_names{"index.html", "grades.json", "grades.csv"};
/// Those, and every student's page.
Expected<void> write_pages(const ClassResult& result, const std::string& folder);

}  // namespace gnomon::app::grade
