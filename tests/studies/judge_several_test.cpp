// The table and the page of several captures, from rows made by hand.
#include <gtest/gtest.h>

#include <filesystem>

#include "judge/several.h"
#include "scene/files/read_file.h"

namespace gnomon::test {
namespace {

using judge::JudgedRow;
using judge::JudgedSet;

JudgedRow judged_as(const std::string& name, std::uint64_t compared, double wrong) {
  JudgedRow row;
  row.name = name, row.figures.pixels.compared = compared, row.figures.error.wrong_fraction = wrong;
  return row;
}

JudgedSet set_of_four() {
  JudgedSet set;
  set.rows = {judged_as("nothing", 0, 0.0), judged_as("shot#1", 100, 0.0), judged_as("50%25", 100, 0.5)};
  set.add_refused("refused", "no such file");
  return set;
}

TEST(JudgedSets, ListWhatWasNotComparedBelowWhatWas) {
  const std::string table = judge::judged_table(set_of_four());
  std::size_t before = 0;
  for (const char* name : {"\n50%25 ", "\nshot#1 ", "\nnothing ", "\nrefused "}) {
    const std::size_t at = table.find(name, before);
    ASSERT_NE(at, std::string::npos) << name << " in " << table;
    before = at;
  }
  const std::size_t row = table.find("\nnothing ") + 1;
  const std::string line = table.substr(row, table.find('\n', row) - row);
  EXPECT_TRUE(line.ends_with("  nothing compared")) << line;
}

TEST(JudgedSets, LinkToFoldersOfAnyName) {
  const std::string folder = testing::TempDir() + "/gnomon-judged-sets";
  std::filesystem::create_directories(folder);
  ASSERT_TRUE(judge::write_judged_set(set_of_four(), folder));
  const auto page = read_file(folder + "/report.html");
  ASSERT_TRUE(page);
  EXPECT_NE(page->find(R"("name":"shot#1","folder":"shot%231")"), std::string::npos);
  EXPECT_NE(page->find(R"("name":"50%25","folder":"50%2525")"), std::string::npos);
}

}  // namespace
}  // namespace gnomon::test
