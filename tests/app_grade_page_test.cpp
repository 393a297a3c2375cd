// Pages of students: one for each, whatever their names are.
#include <gtest/gtest.h>

#include <set>

#include "app/grade/page.h"

namespace gnomon::app::grade {
namespace {

TEST(GradePage, EveryNameHasAPageOfItsOwn) {
  std::set<std::string> pages{"index.html", "grades.json", "grades.csv"};
  for (const char* name : {"anna", "a b", "a_20b", "a/b", "a.b", "index", "index_", "index_5f"}) {
    StudentResult student;
    student.name = name;
    EXPECT_TRUE(pages.insert(page_name(student)).second) << name << ": " << page_name(student);
  }
}

}  // namespace
}  // namespace gnomon::app::grade
