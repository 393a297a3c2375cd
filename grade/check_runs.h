// The drawings of one student (or of the program's own shader), each made once however many checks look at it.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "grade/figures.h"
#include "grade/handed_in.h"
#include "grade/limited_process.h"
#include "grade/rubric.h"

namespace gnomon::grade {

/// A drawing, or why there is none.
struct Drawing {
  std::optional<RunResult> result;
  std::string failure;  ///< one line
  std::string excerpt;  ///< lines of the student's file around an error; may be empty
  bool out_of_time = false;
  /// Something else than the shader may have ended it: it is worth another try with nothing else drawn.
  bool disturbed = false;
};

class CheckRuns {
 public:
  /// `shaders`: the student's folder, or what was made of it; empty for the program's own. Drawings lie below `folder`.
  CheckRuns(const Rubric& rubric, std::string shaders, std::string folder);
  /// Messages of shaders' mistakes name these files by the places where they were found.
  void call_shaders(std::vector<HandedFile> files) { shown_files_ = std::move(files); }

  /// From here on each drawing is a process of its own, so that any thread may ask for one.
  void end_process() { process_.reset(); }

  /// One process makes these, in the order in which they are asked for; after one that failed a new one goes on.
  /// A drawing that was disturbed is handed out as such the first time; drawn again it is an error, or the shader's
  /// own fault.
  /// Errors (resources): no process, or nobody can tell what the shader draws; (cannot_write): no room for the drawing.
  Expected<const Drawing*> draw(const Run& run);
  /// Once more, timed by the very drawing that is judged, with its values; to be called when nothing else runs.
  Expected<Drawing> draw_timed(const Run& run);
  /// The program's own shader with this bias in place of the run's, world units.
  Expected<Drawing> draw_own_with_bias(const Run& run, double bias) const;
  /// One process draws the run with each folder of `shaders`, which are the program's own. PLACE/NAME then holds values or
  /// answers, and nothing where that could not be drawn. Errors as those of draw().
  Expected<void> draw_each(const Run& run, const std::string& shaders, const std::string& place) const;
  /// "gnomon compare …" or "gnomon shaders --call …", which draws it again in the exercise's folder, where student/ holds what was handed in.
  std::string command(const Run& run) const;

 private:
  /// The command line without what says where things lie.
  std::vector<std::string> words_of(const Run& run, const std::string& folder) const;
  bool needs_values(const Run& run) const;
  /// A message with the file's place as the student knows it.
  std::string as_found(std::string failure) const;
  /// Whether a check asks on which side of the truth the drawing errs.
  bool needs_sides(const Run& run) const;
  /// How a drawing is made, besides what the run says.
  struct Manner {
    bool timed = false, values = false;
    bool again = false;  ///< after one that was disturbed
  };
  Expected<Drawing> make(const Run& run, const std::string& folder, Manner manner);
  /// Again where it was disturbed.
  Expected<Drawing> make_undisturbed(const Run& run, const std::string& folder, Manner manner);
  /// With its values, and with its ties in its figures.
  Expected<Drawing> make_with_ties(const Run& run, const std::string& folder, bool again);

  struct Made {
    Run run;
    Drawing drawing;
  };
  const Rubric* rubric_;
  std::optional<CommandProcess> process_;
  std::string shaders_, folder_;
  std::vector<HandedFile> shown_files_;
  std::deque<Made> made_;  ///< what was handed out stays where it is
};

}  // namespace gnomon::grade
