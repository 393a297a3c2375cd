// Recursive descent with a depth cap; constants are folded and equal steps shared while parsing.
#include "scene/shapes/expression.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <numbers>
#include <optional>

namespace gnomon {
namespace {

struct Function {
  std::string_view name;
  ExpressionOp op;
  int arguments;
};
constexpr std::array<Function, 9> functions{{{"sqrt", ExpressionOp::square_root, 1},
                                             {"abs", ExpressionOp::absolute, 1},
                                             {"sin", ExpressionOp::sine, 1},
                                             {"cos", ExpressionOp::cosine, 1},
                                             {"exp", ExpressionOp::exponential, 1},
                                             {"log", ExpressionOp::logarithm, 1},
                                             {"min", ExpressionOp::minimum, 2},
                                             {"max", ExpressionOp::maximum, 2},
                                             {"pow", ExpressionOp::power, 2}}};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// After the first error everything reads as 0, so that the code stays straight.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Expected<Expression> parse() {
    skip_space();
    if (at_ == text_.size()) error(0, "is empty (allowed: a function of x, y and z)");
    const Step value = sum();
    if (!error_ && at_ < text_.size())
      error(at_, fmt::format("unexpected character (got \"{}\")", shown(at_)));
    // What is not needed for the value was folded away into constants.
    if (error_) return fail(std::move(*error_));
    return Expression{needed(value)};
  }

 private:
  using Step = std::uint16_t;

  void error(std::size_t offset, std::string reason) {
    if (error_) return;
    error_ = Error{ErrorKind::bad_input, std::move(reason)};
    error_->column = static_cast<int>(offset) + 1;
    at_ = text_.size();
  }

  std::string shown(std::size_t offset) const {
    const auto c = static_cast<unsigned char>(text_[offset]);
    return c >= 0x20 && c < 0x7f && c != '"' ? std::string(1, text_[offset]) : fmt::format("\\x{:02x}", c);
  }

  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }
  bool take(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    skip_space();
    return true;
  }

  /// The place of an equal step, or of a new one.
  Step put(const ExpressionStep& step) {
    const auto found = std::find(steps_.begin(), steps_.end(), step);
    if (found != steps_.end()) return static_cast<Step>(found - steps_.begin());
    if (steps_.size() == Expression::max_steps) {
      error(at_, fmt::format("too many operations (allowed {})", Expression::max_steps));
      return 0;
    }
    steps_.push_back(step);
    return static_cast<Step>(steps_.size() - 1);
  }
  Step constant(double value, std::size_t offset) {
    if (!std::isfinite(value)) error(offset, fmt::format("has no finite value here (got {})", value));
    return put({ExpressionOp::constant, 0, 0, 0, value});
  }
  bool is_constant(Step s) const { return steps_[s].op == ExpressionOp::constant; }

  Step combine(ExpressionOp op, Step a, Step b, std::size_t offset, int exponent = 0) {
    if (error_) return 0;
    const ExpressionStep step{op, a, b, exponent, 0.0};
    if (!is_constant(a) || !is_constant(b)) return put(step);
    const Expression tiny{{steps_[a], steps_[b], {op, 0, 1, exponent, 0.0}}};
    return constant(evaluate(tiny, 0.0, 0.0, 0.0), offset);
  }

  Step sum() {
    const Deeper deeper(*this);
    Step left = product();
    for (;;) {
      skip_space();
      const std::size_t offset = at_;
      if (take('+'))
        left = combine(ExpressionOp::add, left, product(), offset);
      else if (take('-'))
        left = combine(ExpressionOp::subtract, left, product(), offset);
      else
        return left;
    }
  }

  Step product() {
    Step left = sign();
    for (;;) {
      skip_space();
      const std::size_t offset = at_;
      if (take('*'))
        left = combine(ExpressionOp::multiply, left, sign(), offset);
      else if (take('/'))
        left = combine(ExpressionOp::divide, left, sign(), offset);
      else
        return left;
    }
  }

  Step sign() {
    const Deeper deeper(*this);
    skip_space();
    const std::size_t offset = at_;
    if (take('+')) return sign();
    if (take('-')) {
      const Step a = sign();
      return combine(ExpressionOp::negate, a, a, offset);
    }
    return power();
  }

  Step power() {
    const Step base = atom();
    skip_space();
    const std::size_t offset = at_;
    if (!take('^')) return base;
    return raise(base, sign(), offset);
  }

  Step raise(Step base, Step exponent, std::size_t offset) {
    if (error_) return 0;
    if (!is_constant(exponent)) return combine(ExpressionOp::power, base, exponent, offset);
    const double n = steps_[exponent].value;
    if (n != std::floor(n)) return combine(ExpressionOp::power, base, exponent, offset);
    if (std::abs(n) > Expression::max_whole_power)
      error(offset, fmt::format("exponent out of range (got {}, allowed -{} to {})", n,
                                Expression::max_whole_power, Expression::max_whole_power));
    return combine(ExpressionOp::whole_power, base, base, offset, error_ ? 0 : static_cast<int>(n));
  }

  Step atom() {
    skip_space();
    if (error_) return 0;
    if (at_ == text_.size()) {
      error(at_, "ends too early (allowed: a number, x, y, z, a function or a parenthesis)");
      return 0;
    }
    if (take('(')) {
      const Step inner = sum();
      expect(')');
      return inner;
    }
    if (is_digit(text_[at_]) || text_[at_] == '.') return number();
    if (is_letter(text_[at_])) return name();
    error(at_, fmt::format("unexpected character (got \"{}\", allowed a number, x, y, z, a function or a "
                           "parenthesis)",
                           shown(at_)));
    return 0;
  }

  void expect(char c) {
    if (!take(c) && !error_) error(at_, fmt::format("\"{}\" is missing", c));
  }

  Step number() {
    const std::size_t begin = at_;
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (problem == std::errc::invalid_argument) {
      error(begin, "is not a number");
      return 0;
    }
    if (problem == std::errc::result_out_of_range) {
      error(begin, "number out of range");
      return 0;
    }
    at_ = static_cast<std::size_t>(end - text_.data());
    return constant(value, begin);
  }

  Step name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view word = text_.substr(begin, at_ - begin);
    if (word == "x") return put({ExpressionOp::x});
    if (word == "y") return put({ExpressionOp::y});
    if (word == "z") return put({ExpressionOp::z});
    if (word == "pi") return constant(std::numbers::pi, begin);
    for (const Function& f : functions)
      if (f.name == word) return call(f, begin);
    error(begin, fmt::format("unknown name (got \"{}\", allowed x, y, z, pi, sqrt, abs, sin, cos, exp, log, "
                             "min, max, pow)",
                             word));
    return 0;
  }

  Step call(const Function& f, std::size_t begin) {
    expect('(');
    const Step a = sum();
    Step b = a;
    if (f.arguments == 2) {
      if (!take(',')) error(at_, fmt::format("{} needs two arguments", f.name));
      b = sum();
    } else if (at_ < text_.size() && text_[at_] == ',') {
      error(at_, fmt::format("{} has one argument", f.name));
    }
    expect(')');
    if (f.op == ExpressionOp::power) return raise(a, b, begin);
    return combine(f.op, a, b, begin);
  }

  /// Counts nested calls.
  struct Deeper {
    Parser& parser;
    explicit Deeper(Parser& p) : parser(p) {
      if (++parser.depth_ > Expression::max_depth)
        parser.error(parser.at_, fmt::format("too deeply nested (allowed {})", Expression::max_depth));
    }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    ~Deeper() { --parser.depth_; }
  };

  static int operands(ExpressionOp op) {
    switch (op) {
      case ExpressionOp::constant:
      case ExpressionOp::x:
      case ExpressionOp::y:
      case ExpressionOp::z:
        return 0;
      default:
        return 2;  // functions of one argument name it twice
    }
  }

  /// The steps that lead to `value`, renumbered.
  std::vector<ExpressionStep> needed(Step value) const {
    std::vector<char> wanted(steps_.size(), 0);
    wanted[value] = 1;
    for (std::size_t i = steps_.size(); i-- > 0;)
      if (wanted[i] && operands(steps_[i].op) > 0) wanted[steps_[i].a] = wanted[steps_[i].b] = 1;
    std::vector<Step> place(steps_.size(), 0);
    std::vector<ExpressionStep> out;
    for (std::size_t i = 0; i <= value; ++i) {
      if (!wanted[i]) continue;
      place[i] = static_cast<Step>(out.size());
      ExpressionStep step = steps_[i];
      if (operands(step.op) > 0) step.a = place[step.a], step.b = place[step.b];
      out.push_back(step);
    }
    return out;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<ExpressionStep> steps_;
  std::optional<Error> error_;
};

}  // namespace

Expected<Expression> parse_expression(std::string_view text) {
  return Parser(text).parse();
}

}  // namespace gnomon
