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

/// Students whose answers are alike, directly or by way of others.
struct AlikeGroup {
  std::vector<std::size_t> students;  ///< in the class's order
  double share = 0.0;                 ///< the least of its pairs
  bool same_text = false;             ///< of all of them
};
/// Puts pairs together, so that ten equal answers are one group; the largest first.
std::vector<AlikeGroup> groups_of(const std::vector<AlikePair>& pairs);

/// Returns the words of a shader in which names, layout, comments and preprocessor lines do not count. A name that is not among
/// `known` (sorted) is "name", and every other word is as it stands.
std::vector<std::string> plain_words(std::string_view shader, const std::vector<std::string>& known);

/// An answer: the shaders that a student handed in, one after the other.
using Answer = std::string;

/// Finds pairs that share at least four fifths of the shorter answer's own passages of eight words, the likest first, or have
/// the very same text. A passage is an answer's own where it is not in `given` (what students begin with, and the program's own
/// shaders). In a class of six or more it must not be in half of the answers either. With fewer than twelve of them an answer is
/// too short to say. Macros are put in first, so that a name hides nothing. After Schleimer, Wilkerson and Aiken, "Winnowing: Local Algorithms for Document Fingerprinting", SIGMOD 2003
/// (every passage is kept, for answers are short).
std::vector<AlikePair> find_alike(const std::vector<Answer>& answers, const std::vector<std::string>& given);

/// Finds such pairs among the answers to a rubric; an empty answer is like no other.
std::vector<AlikePair> alike_in(const std::vector<Answer>& answers, const Rubric& rubric);

}  // namespace gnomon::grade
