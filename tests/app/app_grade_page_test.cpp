// Pages of students: one for each, whatever their names are, and each with a content-security policy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "grade/results.h"
#include "tests/support/app_process.h"

namespace gnomon::grade {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += text;
  return out;
}

const std::vector<std::string>& hostile_names() {
  static const std::vector<std::string> names = {"anna",
                                                 "Anna",
                                                 "ANNA",
                                                 "a b",
                                                 "a_20b",
                                                 "A_20B",
                                                 "a/b",
                                                 "a.b",
                                                 "index",
                                                 "Index",
                                                 "index_",
                                                 "index_5f",
                                                 ".",
                                                 "..",
                                                 ".hidden",
                                                 "_2ehidden",
                                                 "",
                                                 "\xff\xfe",
                                                 "\xff",
                                                 "a\nb",
                                                 "<b>&\"'",
                                                 "CON",
                                                 repeated("x", 255),
                                                 repeated("x", 254) + "y",
                                                 repeated("X", 255),
                                                 repeated("\xd0\x96", 127),
                                                 repeated("\xe5\xad\xa6", 85),
                                                 repeated("\xe5\xad\xa6", 84) + "abc",
                                                 repeated("\xf0\x9f\x8e\x93", 63)};
  return names;
}

TEST(GradePage, EveryNameHasAPageOfItsOwn) {
  // A folder called like the page of another does not take it.
  std::vector<std::string> names = hostile_names();
  for (const std::string& page : page_names(hostile_names()))
    names.push_back(page.substr(0, page.size() - 5));
  std::set<std::string> pages{"index.html", "grades.json", "grades.csv"};
  for (std::string page : page_names(names)) {
    EXPECT_LE(page.size(), 96u) << page;
    EXPECT_NE(page.front(), '.') << page;
    EXPECT_EQ(page.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-"),
              std::string::npos)
        << page;
    for (char& c : page) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    EXPECT_TRUE(pages.insert(page).second) << page;
  }
}

TEST(GradePage, AnOrdinaryNameIsThePages) {
  EXPECT_EQ(page_names({"anna", "Bert-2", "c d"}),
            (std::vector<std::string>{"anna.html", "Bert-2.html", "c_20d.html"}));
}

TEST(GradePage, NoPageRunsWhatAStudentWrote) {
  Rubric rubric;
  rubric.title = "<script>alert(1)</script>";
  rubric.checks.emplace_back();
  const StudentResult graded{"<img src=x onerror=alert(1)>", {CheckResult{}}};
  const StudentResult failed{"x", {CheckResult{}}, Error{ErrorKind::bad_input, "<b>no</b>"}};
  const std::vector<StudentResult> students{graded, failed};
  for (const std::string& page : {student_page(rubric, graded), student_page(rubric, failed),
                                  class_page({rubric, students, "gnomon grade"})}) {
    EXPECT_EQ(app_test::policy_of(page).find("script-src 'none'"),
              app_test::policy_of(page).find("script-src"))
        << page;
    EXPECT_NE(app_test::policy_of(page).find("default-src 'none'"), std::string::npos) << page;
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_EQ(page.find("<img"), std::string::npos);
    EXPECT_EQ(page.find(" style="), std::string::npos) << "the policy leaves it out";
  }
}

// Points that were not lost are not written as zero.
TEST(GradePage, WhoWasNotGradedHasNoPoints) {
  Rubric rubric;
  rubric.title = "One";
  rubric.checks.emplace_back();
  rubric.checks[0].points = 2.0;
  const std::vector<StudentResult> students{{"anna", {CheckResult{2.0, "good", {}, {}, {}}}},
                                            {"bert",
                                             {CheckResult{0.0, "no", {}, {}, {}}},
                                             Error{ErrorKind::bad_input, "cannot be read", "class/bert"}}};
  const ClassResult result{rubric, students, "gnomon grade"};
  EXPECT_EQ(grade_csv(result), "student,points,of,\nanna,2,2,2\nbert,,2,\n");
  EXPECT_NE(grade_json(result).find("\"points\": null"), std::string::npos);
  EXPECT_EQ(grade_json(result).find("\"points\": 0"), std::string::npos);
  EXPECT_NE(class_page(result).find("not graded"), std::string::npos);
  EXPECT_NE(student_page(rubric, students[1]).find("class/bert: cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace gnomon::grade
