#include "raster/programs/expression_glsl.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::raster {
namespace {

/// The arithmetics differ in their prefix and in how they write sums. In the order of FunctionForm.
struct Arithmetic {
  const char* name;
  const char* type;
  const char* prefix;
  bool has_operators;
  bool is_double = false;
};
constexpr Arithmetic arithmetics[] = {{"function_slope", "Slope", "s_", false},
                                      {"function_gradient", "vec4", "g_", true},
                                      {"function_gradient64", "dvec4", "d_", true, true}};

std::string glsl_number(double value) {
  const double largest = std::numeric_limits<float>::max();
  return fmt::format("{:.9e}", std::clamp(value, -largest, largest));
}

std::string constant(const Arithmetic& a, double value) {
  if (a.is_double) return fmt::format("d_constant({:.17e}LF)", value);
  if (a.has_operators) return fmt::format("g_constant({})", glsl_number(value));
  const auto rounded = static_cast<float>(value);
  const bool exact = static_cast<double>(rounded) == value;
  const float below = exact ? rounded : std::nextafter(rounded, -std::numeric_limits<float>::max());
  const float above = exact ? rounded : std::nextafter(rounded, std::numeric_limits<float>::max());
  return fmt::format("s_constant({}, {})", glsl_number(static_cast<double>(below)),
                     glsl_number(static_cast<double>(above)));
}

std::string step_text(const Arithmetic& arithmetic, const ExpressionStep& s) {
  const auto call = [&](const char* name) { return fmt::format("{}{}(e{})", arithmetic.prefix, name, s.a); };
  const auto call_two = [&](const char* name) {
    return fmt::format("{}{}(e{}, e{})", arithmetic.prefix, name, s.a, s.b);
  };
  const auto sum = [&](const char* name, const char* sign) {
    return arithmetic.has_operators ? fmt::format("e{} {} e{}", s.a, sign, s.b) : call_two(name);
  };
  switch (s.op) {
    case ExpressionOp::constant:
      return constant(arithmetic, s.value);
    case ExpressionOp::x:
      return "x";
    case ExpressionOp::y:
      return "y";
    case ExpressionOp::z:
      return "z";
    case ExpressionOp::negate:
      return arithmetic.has_operators ? fmt::format("-e{}", s.a) : call("neg");
    case ExpressionOp::add:
      return sum("add", "+");
    case ExpressionOp::subtract:
      return sum("sub", "-");
    case ExpressionOp::multiply:
      return call_two("mul");
    case ExpressionOp::divide:
      return call_two("div");
    case ExpressionOp::whole_power:
      return fmt::format("{}power(e{}, {})", arithmetic.prefix, s.a, s.exponent);
    case ExpressionOp::power:
      return call_two("real_power");
    case ExpressionOp::square_root:
      return call("sqrt");
    case ExpressionOp::absolute:
      return call("abs");
    case ExpressionOp::sine:
      return call("sin");
    case ExpressionOp::cosine:
      return call("cos");
    case ExpressionOp::exponential:
      return call("exp");
    case ExpressionOp::logarithm:
      return call("log");
    case ExpressionOp::minimum:
      return call_two("min");
    case ExpressionOp::maximum:
      return call_two("max");
  }
  return "";
}

std::string function_text(const Arithmetic& a, std::size_t index, const Expression& e) {
  std::string out = fmt::format("{0} {1}{2}({0} x, {0} y, {0} z) {{ ", a.type, a.name, index);
  for (std::size_t i = 0; i < e.steps.size(); ++i)
    out += fmt::format("{} e{} = {}; ", a.type, i, step_text(a, e.steps[i]));
  return out + fmt::format("return e{}; }} ", e.steps.size() - 1);
}

std::string choice_text(const Arithmetic& a, std::size_t first, std::size_t count) {
  const char* name = a.name;
  std::string out = fmt::format("{0} {1}(uint function, {0} x, {0} y, {0} z) {{ ", a.type, name);
  for (std::size_t i = first + 1; i < first + count; ++i)
    out += fmt::format("if (function == {}u) return {}{}(x, y, z); ", i, name, i);
  return out + fmt::format("return {}{}(x, y, z); }} ", name, first);
}

}  // namespace

FunctionTable function_table(const World& world) {
  FunctionTable table;
  for (const Shape& shape : world.shapes) {
    table.of_shape.push_back(0);
    const auto* implicit = std::get_if<Implicit>(&shape.geometry);
    if (implicit == nullptr) continue;
    const auto same = [&](const Expression* e) { return e->steps == implicit->function.steps; };
    const auto found = std::find_if(table.functions.begin(), table.functions.end(), same);
    table.of_shape.back() = static_cast<std::uint32_t>(found - table.functions.begin());
    if (found == table.functions.end()) table.functions.push_back(&implicit->function);
  }
  return table;
}

std::string functions_glsl(const FunctionTable& table, std::size_t first, std::size_t count,
                           std::span<const FunctionForm> forms) {
  std::string out;
  for (const FunctionForm form : forms) {
    const Arithmetic& arithmetic = arithmetics[static_cast<std::size_t>(form)];
    for (std::size_t i = first; i < first + count; ++i)
      out += function_text(arithmetic, i, *table.functions[i]);
    out += choice_text(arithmetic, first, count);
  }
  return out;
}

}  // namespace gnomon::raster
