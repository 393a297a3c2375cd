#include "functions/functions.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "functions/make_questions.h"
#include "functions/parts.h"

namespace gnomon::functions {
namespace {

std::string number_words(double number) {
  return number == raster::unwritten_answer ? "nothing" : fmt::format("{:.6g}", number);
}

/// Single precision is all that an answer has.
std::string value_words(const Function& function, Numbers numbers, const Value& value) {
  const AnswerKind kind = function.kind;
  if (kind == AnswerKind::several)
    return value[0] == raster::unwritten_answer ? "nothing" : function.value_words(numbers, value);
  if (kind == AnswerKind::direction && value[0] != raster::unwritten_answer)
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", value[0], value[1], value[2]);
  if (kind == AnswerKind::place_on_ray && value[0] == -1.0) return "no hit";
  return (kind == AnswerKind::place_on_ray && value[0] != raster::unwritten_answer ? "t = " : "") +
         number_words(value[0]);
}

std::vector<Question> make_questions(const Function& function) {
  std::vector<Question> questions = function.questions();
  for (Question& question : questions) question.right = function.right(question.numbers);
  return questions;
}

}  // namespace

std::span<const Function> all_functions() {
  static const std::vector<Function> all = [] {
    std::vector<Function> rows;
    for (const auto* part : {&eye_functions(), &surface_functions(), &light_functions()})
      rows.insert(rows.end(), part->begin(), part->end());
    rows.insert(rows.end(), {grid_step_function(), bvh_walk_function(), bvh_split_function()});
    return rows;
  }();
  return all;
}

const Function* find_function(std::string_view name) {
  for (const Function& function : all_functions())
    if (function.name == name) return &function;
  return nullptr;
}

std::vector<std::string_view> function_names() {
  std::vector<std::string_view> names;
  for (const Function& function : all_functions()) names.push_back(function.name);
  return names;
}

std::string file_of(const Function& function) {
  return fmt::format("function/{}.glsl", function.name);
}

const std::vector<Question>& questions_of(const Function& function) {
  static std::mutex making;
  static std::vector<std::vector<Question>> made(all_functions().size());
  const std::lock_guard lock(making);
  std::vector<Question>& own = made[static_cast<std::size_t>(&function - all_functions().data())];
  if (own.empty()) own = make_questions(function);
  return own;
}

std::vector<std::string_view> groups_of(const Function& function) {
  std::vector<std::string_view> groups;
  for (const Question& question : questions_of(function))
    if (groups.empty() || groups.back() != question.group) groups.push_back(question.group);
  return groups;
}

std::size_t size_of(AnswerKind kind) {
  if (kind == AnswerKind::several) return 4;
  return kind == AnswerKind::direction ? 3 : 1;
}

bool is_right(const Function& function, const Question& question, const raster::Answer& answer) {
  for (std::size_t i = 0; i < size_of(function.kind); ++i)
    if (!(std::abs(double(answer[i]) - question.right.value[i]) <= question.right.tolerance)) return false;
  return true;
}

std::string answer_words(const Function& function, const Question& question, const raster::Answer& answer) {
  const auto right = value_words(function, question.numbers, question.right.value);
  const std::string because =
      question.right.because.empty() ? "" : fmt::format(" ({})", question.right.because);
  if (is_right(function, question, answer))
    return fmt::format("{}: {}{}", function.words(question.numbers), right, because);
  return fmt::format("{}: answered {}, right: {}{}", function.words(question.numbers),
                     value_words(function, question.numbers, {answer[0], answer[1], answer[2], answer[3]}),
                     right, because);
}

Expected<std::vector<raster::Answer>> ask(const Function& function, raster::Backend backend,
                                          const std::string& shader_folder) {
  std::vector<float> inputs;
  for (const Question& question : questions_of(function))
    inputs.insert(inputs.end(), question.numbers.begin(), question.numbers.end());
  return raster::call_function(
      backend, shader_folder,
      {std::string(function.name), std::string(function.call), function.numbers, inputs});
}

}  // namespace gnomon::functions
