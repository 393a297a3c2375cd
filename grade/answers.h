// What a function answered to a group of cases: how many are wrong, the first of them in words, and pictures.
#pragma once

#include <string>
#include <vector>

#include "grade/figures.h"
#include "grade/grade.h"
#include "grade/rubric.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

struct AnswerCount {
  std::size_t cases = 0, wrong = 0;
  std::string first_wrong;  ///< "the ray from ...: answered 2.5, right: no hit"; empty: none is wrong
};
/// Counts the answers to the run's cases.
AnswerCount count_answers(const Run& run, const RunResult& result);

/// Returns what the function answered over a picture of rays, what is right, and where the two differ.
Expected<std::vector<Picture>> answer_pictures(const Run& run, const RunResult& result);

}  // namespace gnomon::grade
