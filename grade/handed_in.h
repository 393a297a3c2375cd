// What of all that a student handed in counts: the shaders that a rubric asks for, wherever they lie and whatever a platform made of
// their names.
#pragma once

#include <string>
#include <vector>

#include "grade/rubric.h"
#include "grade/student.h"
#include "scene/base/expected.h"

namespace gnomon::grade {

struct HandedFile {
  std::string name;   ///< as the exercise has it: "function/ray_box.glsl"
  std::string place;  ///< where it was found: "class/anna/homework.zip/ray_box (1).glsl"
  std::string text;
  std::string refused{};  ///< why this function alone is not called; empty where it is
};

struct HandIn {
  std::string refused;            ///< why nothing of it is drawn with; empty where all is well
  std::vector<HandedFile> files;  ///< by name; of who is refused none
};

/// Looks through folders and archives for the files of `hand_in` and for what these include. A file is found at any depth, in
/// whatever case, with what platforms and browsers add to its name ("reflection (1).glsl", "..._67890_reflection.glsl"). A copy of
/// what students begin with counts where nothing else does.
///
/// Refused is, so that there are no points:
/// - a link, and a folder or a pipe in place of a shader
/// - more than 4 MiB of shaders
/// - a shader of the program's own that is not asked for
/// - one that reaches for what the exercise keeps to itself (shader_rules.h)
/// - nothing that differs from the program's own
///
/// Errors (bad input), so that nobody knows the points:
/// - something cannot be read or opened
/// - two files may be the same one of `hand_in`
/// - there is something, but nothing by a name that counts
Expected<HandIn> take_in(const Student& student, const Rubric& rubric);

/// Returns its texts, one after the other, each include once in its place.
std::string answer_of(const HandIn& handed_in);

/// Puts it beside what the rubric gives, into `folder`. What each file defines for the preprocessor ends with it.
Expected<void> write_with_given(const HandIn& handed_in, const Rubric& rubric, const std::string& folder);

}  // namespace gnomon::grade
