// The functions of the ray-tracing homework, one row each: how it is called, what it is tried on, and what is right. The answers
// themselves come from GLSL, which students write (shaders/function/); what is right is computed in double precision from the
// very numbers that the shader gets.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raster/function_call.h"
#include "scene/base/expected.h"

namespace gnomon::functions {

using Numbers = std::span<const float>;
using Value = std::array<double, 4>;

struct Right {
  Value value{};
  double tolerance = 0.0;  ///< of each number of an answer, in its own unit
  std::string because{};   ///< "the triangle is behind the ray"; may be empty
};

/// One call, and what it should give.
struct Question {
  std::string_view group;      ///< "edges"
  std::vector<float> numbers;  ///< that the shader gets
  Right right{};
};

/// What an answer's numbers are, for people and for pictures.
enum class AnswerKind : std::uint8_t {
  place_on_ray,  ///< one number, t; -1: none
  direction,     ///< three
  number,        ///< one
  several,       ///< four, in words of the function's own
};

struct Function {
  std::string_view name;  ///< as students write it: "ray_box"
  std::string_view call;  ///< raster::FunctionCall::text
  std::size_t numbers;    ///< of a case
  AnswerKind kind;
  std::vector<Question> (*questions)();  ///< without what is right
  Right (*right)(Numbers);
  std::string (*words)(Numbers);  ///< "the ray from (0, 0, 0) towards (0, 0, -1) and ..."
  /// An answer of `several` in words: "cell (2, 0, 1) at t = 1.5". Null for other kinds.
  std::string (*value_words)(Numbers, const Value&) = nullptr;
};

/// All of them, in the order of the lectures.
std::span<const Function> all_functions();
/// Null: there is none of that name.
const Function* find_function(std::string_view name);
std::vector<std::string_view> function_names();
/// "function/ray_box.glsl", among raster::own_shaders().
std::string file_of(const Function& function);

/// Every case with what is right, group after group; made once.
const std::vector<Question>& questions_of(const Function& function);
/// The groups' names, in their order; the last is `picture_group`.
std::vector<std::string_view> groups_of(const Function& function);
/// The cases that are the pixels of a picture, row by row from the top.
inline constexpr std::string_view picture_group = "picture";
inline constexpr int picture_width = 160, picture_height = 90;

/// How many numbers of an answer count.
std::size_t size_of(AnswerKind kind);
bool is_right(const Function& function, const Question& question, const raster::Answer& answer);
/// "the ray from ... and ...: answered 2.5, right: no hit (the triangle is behind the ray)".
std::string answer_words(const Function& function, const Question& question, const raster::Answer& answer);

/// The answers of a shader folder's function to all its questions. Errors as raster::call_function().
Expected<std::vector<raster::Answer>> ask(const Function& function, raster::Backend backend,
                                          const std::string& shader_folder);

// Answers on their way from one process to another: gnomon/answers/1 (answers.schema.json).

std::string answers_json(const Function& function, const std::vector<raster::Answer>& answers);
/// Error (internal): not what answers_json() writes of this function.
Expected<std::vector<raster::Answer>> read_answers(const Function& function, const std::string& path);

}  // namespace gnomon::functions
