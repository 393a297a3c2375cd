// A lecture's deck (docs/lectures/LANGUAGE/NAME.md): slides whose sentences, figures, formulas, tables and questions are
// the lessons' own, each named by the lesson and by words that it begins with:
//
//   ## Why is it one half?                          a slide, and what is asked first
//   <!-- minutes: 2 -->
//   <!-- beyond -->                                 who has less time leaves it out
//   <!-- show: acne figure flatland scene=floor with texels=10 -->
//   <!-- show: cascades pair lesson-cascades.png -->          two pictures in one file, one after the other in one place
//   <!-- show: acne sentence The stored depth is -->
//   <!-- show: acne code shaders/gap.glsl -->                 lines of a source, by words of their mark (project_lesson_code_test.py)
//   > A sentence of the deck's own, where no lesson has it.
//   What is left is for the speaker.
//
// Each part is a step: it is shown when the speaker asks for it. A translation is a folder of such files.
#pragma once

#include <string>
#include <string_view>

#include "scene/base/expected.h"

namespace gnomon::lab::lessons {

/// The part of a lesson's Markdown that `words` name, as Markdown. `kind`: sentence, formula, table and question begin with them;
/// the mark of code and a figure's mark or picture hold them, and what follows " with " is set in the mark instead of the lesson's own.
/// Error (internal): the lesson has no such part.
Expected<std::string> lesson_part(std::string_view markdown, std::string_view kind, std::string_view words);

/// The deck with its parts in place, Markdown as read_lesson() (lab/lessons/lesson_text.h) takes it: a part for the title and one
/// for each slide; each step a <div class="step KIND">, the notes an <aside class="notes" data-minutes="2">, with
/// data-beyond where the slide may be left out.
/// Error (internal): a lesson or a part that is not there, a slide without minutes.
Expected<std::string> lecture_text(std::string_view deck);

}  // namespace gnomon::lab::lessons
