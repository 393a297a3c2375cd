// What the tests of gnomon grade share: a class in a folder of its own, and a rubric of one quick check.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/app_process.h"

namespace gnomon::app_test {

class Grade : public ::testing::Test {
 protected:
  ProcessResult gnomon(const Words& words) const { return run_gnomon(words, {.folder = folder.path()}); }
  void hand_in(const std::string& student, const std::string& text,
               const std::string& file = "technique/hard.glsl") const {
    const std::filesystem::path path = folder / ("class/" + student + "/" + file);
    std::filesystem::create_directories(path.parent_path());
    write_text(path.string(), text);
  }
  /// A rubric of one quick check, and what goes into it.
  void write_rubric(const std::string& members) const {
    write_text(folder / "rubric.json", R"({"schema": "gnomon/rubric/1", "title": "One", "technique": "hard",
      "hand_in": ["technique/hard.glsl"], )" +
                                           members + "}");
  }
  TemporaryFolder folder;
};

inline const std::string one_check =
    R"("checks": [{"name": "draws", "points": 1, "kind": "draws",
      "runs": [{"scene": "acne-floor", "options": {"size": "64x36", "map-size": "64"}}]}])";

}  // namespace gnomon::app_test
