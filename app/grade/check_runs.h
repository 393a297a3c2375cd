// The drawings of one student (or of the program's own shader), each made once however many checks look at it.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "app/grade/figures.h"
#include "app/grade/rubric.h"
#include "app/grade/student.h"

namespace gnomon::app::grade {

/// A drawing, or why there is none.
struct Drawing {
  std::optional<RunResult> result;
  std::string failure;  ///< one line
  bool timed_out = false;
  int exit_code = 0;
};

class CheckRuns {
 public:
  /// `shaders`: the student's folder; empty for the program's own. Drawings lie below `folder`.
  CheckRuns(const Rubric& rubric, std::string shaders, std::string folder);

  /// Error (resources): no process; (cannot_write): no room for the drawing.
  Expected<const Drawing*> draw(const Run& run);
  /// Once more, with the usual number of timed passes, to be called when nothing else runs.
  Expected<Drawing> draw_timed(const Run& run);
  /// The program's own shader with this bias in place of the run's, world units.
  Expected<Drawing> draw_own_with_bias(const Run& run, double bias) const;
  /// "gnomon compare …", which draws it again.
  std::string command(const Run& run) const;

 private:
  bool needs_values(const Run& run) const;
  /// Whether a check asks on which side of the truth the drawing errs.
  bool needs_sides(const Run& run) const;
  Expected<Drawing> make(const Run& run, const std::string& folder, bool timed, bool values) const;
  /// With its values, and with its ties in its figures.
  Expected<Drawing> make_with_ties(const Run& run, const std::string& folder) const;

  struct Made {
    Run run;
    Drawing drawing;
  };
  const Rubric* rubric_;
  std::string shaders_, folder_;
  std::deque<Made> made_;  ///< what was handed out stays where it is
};

}  // namespace gnomon::app::grade
