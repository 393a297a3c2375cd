// Evaluation of an expression in any arithmetic, and the functions that doubles and doubles with a gradient
// need for it. Included by scene/shapes/expression.h alone.
#pragma once

#include <cmath>

#include "scene/shapes/expression.h"

namespace gnomon {

inline double whole_power(double a, int n) {
  double result = 1.0, factor = a;
  for (unsigned k = static_cast<unsigned>(n < 0 ? -n : n); k != 0; k >>= 1) {
    if (k & 1) result *= factor;
    factor *= factor;
  }
  return n < 0 ? 1.0 / result : result;
}
inline double real_power(double a, double b) {
  return a < 0.0 ? std::nan("") : std::pow(a, b);
}
inline double square_root(double a) {
  return std::sqrt(a);
}
inline double absolute(double a) {
  return std::abs(a);
}
inline double sine(double a) {
  return std::sin(a);
}
inline double cosine(double a) {
  return std::cos(a);
}
inline double exponential(double a) {
  return std::exp(a);
}
inline double logarithm(double a) {
  return std::log(a);
}
inline double minimum(double a, double b) {
  return b < a ? b : a;
}
inline double maximum(double a, double b) {
  return a < b ? b : a;
}

/// A value and what it changes by: forward differentiation (Griewank and Walther 2008, chapter 3). Change is
/// a number (along a ray) or a vector (the gradient).
template <class Value, class Change>
struct Differential {
  Value value;
  Change change;
  Differential() = default;
  explicit Differential(double constant) : value(constant), change(0.0) {}
  Differential(const Value& v, const Change& c) : value(v), change(c) {}
};

template <class V, class C>
Differential<V, C> operator-(const Differential<V, C>& a) {
  return {-a.value, -a.change};
}
template <class V, class C>
Differential<V, C> operator+(const Differential<V, C>& a, const Differential<V, C>& b) {
  return {a.value + b.value, a.change + b.change};
}
template <class V, class C>
Differential<V, C> operator-(const Differential<V, C>& a, const Differential<V, C>& b) {
  return {a.value - b.value, a.change - b.change};
}
template <class V, class C>
Differential<V, C> operator*(const Differential<V, C>& a, const Differential<V, C>& b) {
  return {a.value * b.value, b.value * a.change + a.value * b.change};
}
template <class V, class C>
Differential<V, C> operator/(const Differential<V, C>& a, const Differential<V, C>& b) {
  const V inverse = V(1.0) / b.value, quotient = a.value / b.value;
  return {quotient, inverse * (a.change - quotient * b.change)};
}
template <class V, class C>
Differential<V, C> whole_power(const Differential<V, C>& a, int n) {
  if (n == 0) return Differential<V, C>(1.0);
  return {whole_power(a.value, n), (V(double(n)) * whole_power(a.value, n - 1)) * a.change};
}
template <class V, class C>
Differential<V, C> real_power(const Differential<V, C>& a, const Differential<V, C>& b) {
  const V power = real_power(a.value, b.value);
  const C of_base = (b.value * real_power(a.value, b.value - V(1.0))) * a.change;
  return {power, of_base + (power * logarithm(a.value)) * b.change};
}
template <class V, class C>
Differential<V, C> square_root(const Differential<V, C>& a) {
  const V root = square_root(a.value);
  return {root, (V(0.5) / root) * a.change};
}
template <class V, class C>
Differential<V, C> sine(const Differential<V, C>& a) {
  return {sine(a.value), cosine(a.value) * a.change};
}
template <class V, class C>
Differential<V, C> cosine(const Differential<V, C>& a) {
  return {cosine(a.value), (-sine(a.value)) * a.change};
}
template <class V, class C>
Differential<V, C> exponential(const Differential<V, C>& a) {
  const V power = exponential(a.value);
  return {power, power * a.change};
}
template <class V, class C>
Differential<V, C> logarithm(const Differential<V, C>& a) {
  return {logarithm(a.value), (V(1.0) / a.value) * a.change};
}
template <class C>
Differential<double, C> absolute(const Differential<double, C>& a) {
  return a.value < 0.0 ? -a : a;
}
template <class C>
Differential<double, C> minimum(const Differential<double, C>& a, const Differential<double, C>& b) {
  return b.value < a.value ? b : a;
}
template <class C>
Differential<double, C> maximum(const Differential<double, C>& a, const Differential<double, C>& b) {
  return a.value < b.value ? b : a;
}

template <class Number>
Number evaluate(const Expression& expression, const Number& x, const Number& y, const Number& z) {
  std::array<Number, Expression::max_steps> at;
  std::size_t count = 0;
  for (const ExpressionStep& s : expression.steps) {
    const auto a = [&]() -> const Number& { return at[s.a]; };
    const auto b = [&]() -> const Number& { return at[s.b]; };
    Number& out = at[count++];
    switch (s.op) {
      case ExpressionOp::constant:
        out = Number(s.value);
        break;
      case ExpressionOp::x:
        out = x;
        break;
      case ExpressionOp::y:
        out = y;
        break;
      case ExpressionOp::z:
        out = z;
        break;
      case ExpressionOp::negate:
        out = -a();
        break;
      case ExpressionOp::add:
        out = a() + b();
        break;
      case ExpressionOp::subtract:
        out = a() - b();
        break;
      case ExpressionOp::multiply:
        out = a() * b();
        break;
      case ExpressionOp::divide:
        out = a() / b();
        break;
      case ExpressionOp::whole_power:
        out = whole_power(a(), s.exponent);
        break;
      case ExpressionOp::power:
        out = real_power(a(), b());
        break;
      case ExpressionOp::square_root:
        out = square_root(a());
        break;
      case ExpressionOp::absolute:
        out = absolute(a());
        break;
      case ExpressionOp::sine:
        out = sine(a());
        break;
      case ExpressionOp::cosine:
        out = cosine(a());
        break;
      case ExpressionOp::exponential:
        out = exponential(a());
        break;
      case ExpressionOp::logarithm:
        out = logarithm(a());
        break;
      case ExpressionOp::minimum:
        out = minimum(a(), b());
        break;
      case ExpressionOp::maximum:
        out = maximum(a(), b());
        break;
    }
  }
  return at[count - 1];
}

}  // namespace gnomon
