// A function f(x, y, z) as a person writes it, ready to be evaluated in any arithmetic: doubles, doubles with
// a derivative, intervals. Grammar, loosest first (^ binds to the right and tighter than a sign: -x^2 is
// -(x^2)):
//   sum = product { (+|-) product }    product = sign { (*|/) sign }    sign = (+|-) sign | power
//   power = atom [ ^ sign ]            atom = number | x | y | z | pi | ( sum ) | name ( sum {, sum} )
// with the names sqrt abs sin cos exp log (one argument) and min max pow (two). Equal parts are worked out
// once.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

enum class ExpressionOp : std::uint8_t {
  constant,
  x,
  y,
  z,
  negate,
  add,
  subtract,
  multiply,
  divide,
  whole_power,  ///< a ^ exponent, a whole number
  power,        ///< a ^ b for a >= 0 (a > 0 where b <= 0)
  square_root,
  absolute,
  sine,
  cosine,
  exponential,
  logarithm,
  minimum,
  maximum
};

/// One step; `a` and `b` are earlier steps.
struct ExpressionStep {
  ExpressionOp op = ExpressionOp::constant;
  std::uint16_t a = 0, b = 0;
  int exponent = 0;    ///< of whole_power
  double value = 0.0;  ///< of constant
  bool operator==(const ExpressionStep&) const = default;
};

/// The last step is the value. Parsing gives at least one step and at most max_steps.
struct Expression {
  static constexpr std::size_t max_steps = 256;
  static constexpr int max_depth = 64, max_whole_power = 64;
  std::vector<ExpressionStep> steps;
};

/// Error (bad_input) with the column, from 1, in the text.
Expected<Expression> parse_expression(std::string_view text);

/// The value at (x, y, z). Number needs +, -, *, /, a constructor from double, and whole_power, real_power,
/// square_root, absolute, sine, cosine, exponential, logarithm, minimum, maximum found by its namespace.
template <class Number>
Number evaluate(const Expression& expression, const Number& x, const Number& y, const Number& z);

}  // namespace gnomon

#include "scene/shapes/expression_evaluate.h"
