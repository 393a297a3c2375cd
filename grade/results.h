// What a class was given, for people and for programs.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grade/alike.h"
#include "grade/grade.h"
#include "scene/base/expected.h"
#include "scene/files/staged_files.h"

namespace gnomon::grade {

std::vector<std::string> page_names_of(const std::vector<StudentResult>& students);

struct ClassResult {
  const Rubric& rubric;
  const std::vector<StudentResult>& students;
  std::string command_line;
  std::vector<AlikePair> alike{};  ///< places in `students`
  std::vector<std::string> pages =
      page_names_of(students);  ///< the files of the students' pages, in their order
};

/// gnomon/grade/1 (grade.schema.json).
std::string grade_json(const ClassResult& result);
/// One row for each student: name, points, of, and the points of each check; no points stand where nothing was graded.
std::string grade_csv(const ClassResult& result);
/// The same for a learning platform to read in.
enum class CsvForm : std::uint8_t {
  points,  ///< grade_csv()
  moodle,  ///< Moodle's offline grading worksheet: identifier, name, grade, the most there is, feedback
  canvas   ///< Canvas' gradebook: student, ID, and the points below the rubric's title
};
std::string grade_csv(const ClassResult& result, CsvForm form);
/// One paragraph for each student: points, and every check that lost some, with the reason; or why there are none.
std::string grade_table(const ClassResult& result);
/// "anna, bert and carl: the very same text", "anna and bert: 94 % of what is their own, names aside".
std::string alike_words(const ClassResult& result, const AlikeGroup& group);

/// What several of a class have in common, so that the next lesson can begin with it.
struct CommonLoss {
  std::string words;        ///< "eye_ray as if the ray went through the pixel's corner", or a check's name
  bool is_mistake = false;  ///< named, or a check that lost points without a name
  std::vector<std::size_t> students;
};
/// Mistakes that are named, the most frequent first, then checks that lost points without a name, likewise; each of two students or more.
std::vector<CommonLoss> common_losses(const ClassResult& result);
/// "14 of 60: eye_ray as if the ray went through the pixel's corner (0.5 is left out)".
std::string loss_words(const ClassResult& result, const CommonLoss& loss);
/// "17.5 of 20".
std::string points_text(double points, double of);

// The files of the students' pages.

/// For each student's name, which may hold any bytes, a file's name of at most 96 bytes, "anna.html": ASCII letters,
/// digits, '-', '.' and '_' alone, not hidden. No two of them, nor one and "index.html", differ in nothing but case: they
/// stay apart where a folder of pages is copied to.
std::vector<std::string> page_names(const std::vector<std::string>& students);

// Pages to hand out: one for each student, and a table of the class. They need no server and no network.

std::string student_page(const Rubric& rubric, const StudentResult& student);
std::string class_page(const ClassResult& result);
/// What write_pages() always writes.
inline constexpr std::array<std::string_view, 3> class_file_names{"index.html", "grades.json", "grades.csv"};
/// Before anything is drawn: whether these pages can be put there. ErrorKind::cannot_write.
Expected<void> check_pages(const std::string& folder, const std::vector<std::string>& pages);
/// Writes those files and every student's page, and some elsewhere: all of them appear, or none. Errors: ErrorKind::usage
/// where one would take the place of one of `inputs`, ErrorKind::cannot_write.
Expected<void> write_pages(const ClassResult& result, const std::string& folder,
                           const std::vector<std::string>& inputs, std::span<const FileText> elsewhere);

}  // namespace gnomon::grade
