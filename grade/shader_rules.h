// What a handed-in shader may not say, so that nothing in it reaches behind its own end: the program's names stay what they are. All of
// it is read as the preprocessor reads it (GLSL 4.50, 3.1 to 3.4): lines that a backslash joins are one, comments are blanks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grade/rubric.h"

namespace gnomon::grade {

/// A line as the preprocessor sees it.
struct LogicalLine {
  int number = 0;  ///< of its first line in the file, from 1
  std::string text;
};
std::vector<LogicalLine> logical_lines(const std::string& text);

/// A letter, a digit or "_".
bool is_letter_of_name(char c);

/// "define" and what stands behind it; nothing where a line is none of the preprocessor's.
struct Directive {
  std::string word, rest;
};
Directive directive_of(std::string_view line);

/// Why a text is refused, with the line; empty where it is not. `place` is what the message begins with. `of_macro`: it is for a macro's
/// name, and for nothing worse.
/// In every exercise: a macro of a name of GLSL's, of a given file's or of the program's own macros; #undef of such a name, #line,
/// #extension, #version. Where the exercise keeps something to itself (functions, or files beside given ones) also: any #undef, "##",
/// an #include of the program's files. In functions the words that lead to the cases: uniform, buffer, layout, texelFetch, gl_..., ....
std::string why_refused(const std::string& place, const std::string& text, const Rubric& rubric,
                        bool* of_macro = nullptr);

/// "#undef a" for every macro that the text defines, so that they end where it ends.
std::string ending_macros(const std::string& text);

}  // namespace gnomon::grade
