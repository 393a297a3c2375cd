// What a check says of one drawing.
#pragma once

#include <deque>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <utility>

#include "grade/check_runs.h"
#include "grade/mistakes.h"
#include "grade/rubric.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

/// What all students share.
struct Class {
  const Rubric& rubric;
  std::string work_folder;
  CheckRuns own;  ///< the program's shader
  Mistakes mistakes;
  std::deque<std::pair<Run, DrawnValues>> own_values{};
  std::mutex own_mutex{};
  std::shared_mutex quiet{};  ///< held alone by a drawing that is timed
};

struct Judgement {
  bool passed = false;
  std::string reason;
  double share = 0.0;  ///< of the points where it did not pass, < 1
};

/// Draws it again, with nothing drawn beside it, where something else than the shader may have ended it.
Expected<const Drawing*> draw_undisturbed(CheckRuns& runs, const Run& run, std::shared_mutex& quiet);

/// `result`: what `runs` made of the run. Errors: those of further drawings that the kind of check asks for.
Expected<Judgement> judge(const Check& check, const Run& run, const RunResult& result, CheckRuns& runs,
                          Class& of);

}  // namespace gnomon::grade
