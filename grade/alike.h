// Answers of a class that are alike beyond what the exercise gives and what most of the class has found.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grade/rubric.h"

namespace gnomon::grade {

/// Two students whose answers are alike.
struct AlikePair {
  std::size_t first = 0, second = 0;  ///< in the class's order, first < second
  double share = 0.0;      ///< of the shorter answer's own passages that the other has, too, (0, 1]
  bool same_text = false;  ///< letter for letter
};

/// Returns the words of a shader in which names, layout, comments and preprocessor lines do not count. A name that is not among
/// `known` (sorted) is "name", and every other word is as it stands.
std::vector<std::string> plain_words(std::string_view shader, const std::vector<std::string>& known);

/// An answer: the shaders that a student handed in, one after the other.
using Answer = std::string;

/// Finds pairs that share at least four fifths of the shorter answer's own passages of eight words, the likest first, or have
/// the very same text. A passage is an answer's own where it is not in `given` (what students begin with, and the program's own
/// shaders). In a class of six or more it must not be in half of the answers either. With fewer than twelve of them an answer is
/// too short to say. After Schleimer, Wilkerson and Aiken, "Winnowing: Local Algorithms for Document Fingerprinting", SIGMOD 2003
/// (every passage is kept, for answers are short).
std::vector<AlikePair> find_alike(const std::vector<Answer>& answers, const std::vector<std::string>& given);

/// Finds such pairs in what a class handed in for a rubric. Nothing that is refused or cannot be read is like anything.
std::vector<AlikePair> find_alike(const std::vector<Student>& students, const Rubric& rubric);

}  // namespace gnomon::grade
