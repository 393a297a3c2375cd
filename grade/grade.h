// Grades a class: every student's shaders against every check of a rubric. Each student has a process for the drawings, and one more
// for each that is timed. Anybody can repeat a drawing: `gnomon compare`, or `gnomon shaders --call` for a function. So nothing
// that a shader does reaches the grader or another student.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison.h"
#include "grade/rubric.h"
#include "grade/student.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

struct Picture {
  std::string caption;
  std::string png;                     ///< bytes
  std::vector<compare::Label> labels;  ///< whose colours it shows
};

struct CheckResult {
  double points = 0.0;  ///< of the check's; less where a limit is missed, none where by as much again
  std::string reason;   ///< what was measured, or why there are no points; one line
  std::string command;  ///< that draws it again; of the run that lost the points, else of the first
  std::vector<Picture> pictures;  ///< where points were lost and something was drawn
  std::string excerpt;            ///< lines of the student's file around an error; may be empty
  bool mistake_named =
      false;  ///< a usual mistake explains what was drawn: later checks go on as if it were mended
  std::string mistake{};  ///< which: "the tangent was halved, not the angle"; empty: none is named
};

struct StudentResult {
  std::string name;
  std::vector<CheckResult> checks;  ///< in the rubric's order
  /// Why nothing could be judged, which is no fault of the shader's: then there are no points, given or lost.
  std::optional<Error> error = std::nullopt;
  std::string answer{};       ///< what counts of what was handed in; empty: nothing
  Participant participant{};  ///< as a platform knows the student
  double points() const;
};

struct GradeOptions {
  int jobs = 0;  ///< students at a time; 0: as many as there are processors
  /// Called from any thread, one call at a time.
  std::function<void(double done)> progress;
};

/// Who is graded where there are no students.
inline constexpr std::string_view own_shader_name = "the program's own shader";

struct Grades {
  StudentResult
      own;  ///< the program's own shader, as if it were handed in: whether a rubric asks what is possible
  std::vector<StudentResult> students;  ///< in their order
};

/// `work_folder` exists; drawings are made below it, in folders called `own` and by numbers. What goes wrong with one
/// student stands in that student's result. Error (bad input): a scene or an option of the rubric that the program does not
/// take.
Expected<Grades> grade_class(const Rubric& rubric, const std::vector<Student>& students,
                             const std::string& work_folder, const GradeOptions& options);

// The lines of a shader that an error is about.

/// For "DIR/technique/hard.glsl:3: …" the lines around the third, numbered, that one marked with ">"; empty where the
/// text names no line of a file in `folder`.
std::string excerpt_at(const std::string& error, const std::string& folder);

// The rubrics that come with the program, each with what a class needs to begin.

/// "first-shadow-map", …
std::vector<std::string> kit_names();
bool is_kit(const std::string& name);

/// Writes the kit, all of it or nothing: rubric.json, its scenes, README.md, and student/ with the shader to be filled in.
/// `called`: how the program was started, which README.md repeats. Of a path such as "./gnomon" its commands are those of the folder in
/// which it was typed. Errors (cannot write): a file of another content is there already.
Expected<void> write_kit(const std::string& name, const std::string& folder,
                         const std::string& called = "gnomon");

}  // namespace gnomon::grade
