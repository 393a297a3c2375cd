// Answers that are alike: a copy with other names, layout and comments is found; what the exercise gives, what most of a class
// writes, and what is short, is not held against anybody.
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <array>
#include <regex>

#include "grade/alike.h"

namespace gnomon::grade {
namespace {

const std::string given = "float light_that_arrives(vec3 position, vec3 normal) {\n  return 1.0;\n}\n";

/// An answer of its own: constants and the order of operations follow from the number.
std::string own_answer(int number) {
  std::string text = "float light_that_arrives(vec3 position, vec3 normal) {\n";
  for (int line = 0; line < 12; ++line) {
    const int which = (7 * number + 3 * line) % 5;
    text +=
        fmt::format("  float v{} = {}({}.{} * {}.{}) {} {}.{}{};\n", line,
                    std::array{"sin", "cos", "sqrt", "abs", "floor"}[static_cast<std::size_t>(which)], number,
                    line, line + 1, number * number % 97, "+-*/"[(number + line) % 4], line, number, which);
  }
  return text + "  return v3;\n}\n";
}

TEST(Alike, PlainWordsAreWhatTheProgramMeans) {
  const std::vector<std::string> words =
      plain_words("#define A 1\nfloat  x = 1.5e2; /* x */ // y\nreturn x;", {"float", "return"});
  EXPECT_EQ(words, (std::vector<std::string>{"float", "name", "=", "1.5e2", ";", "return", "name", ";"}));
}

TEST(Alike, ACopyWithOtherNamesAndLayoutIsFound) {
  std::string copy = std::regex_replace(own_answer(3), std::regex("\\bv([0-9]+)"), "my_$1");
  copy = std::regex_replace(copy, std::regex(";\n"), ";  // so\n\n");
  const std::vector<AlikePair> pairs =
      find_alike({own_answer(1), own_answer(3), own_answer(5), copy}, {given});
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, 1u);
  EXPECT_EQ(pairs[0].second, 3u);
  EXPECT_EQ(pairs[0].share, 1.0);
  EXPECT_FALSE(pairs[0].same_text);
}

TEST(Alike, WhatIsGivenAndWhatMostWriteIsNobodysOwn) {
  std::vector<Answer> answers;
  for (int i = 0; i < 8; ++i) answers.push_back(own_answer(3));  // the one way that the exercise leaves
  for (std::size_t i = 0; i < answers.size(); ++i) answers[i] += fmt::format("// {}\n", i);
  EXPECT_TRUE(find_alike(answers, {given}).empty());
  answers.resize(3);  // in a small group nobody knows what is usual
  EXPECT_EQ(find_alike(answers, {given}).size(), 3u);
  EXPECT_TRUE(find_alike(answers, {given, own_answer(3)}).empty()) << "all of it was given";
}

TEST(Alike, ShortAnswersAreAlikeOnlyLetterForLetter) {
  const std::string one = "float light_that_arrives(vec3 p) { return p.x > 0.25 ? 0.0 : 1.0; }\n";
  EXPECT_TRUE(find_alike({one, "// mine\n" + one}, {given}).empty());
  const auto pairs = find_alike({one, "", one, ""}, {given});
  ASSERT_EQ(pairs.size(), 1u) << "who handed in nothing is like nobody";
  EXPECT_TRUE(pairs[0].same_text);
}

}  // namespace
}  // namespace gnomon::grade
