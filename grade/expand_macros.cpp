#include "grade/expand_macros.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "grade/shader_rules.h"

namespace gnomon::grade {

namespace {

constexpr std::size_t largest_text = 1 << 20;  // bytes
constexpr int deepest = 8;                     // macros in macros

struct Macro {
  bool takes_arguments = false;
  std::vector<std::string> parameters;
  std::string body;
};
using Macros = std::map<std::string, Macro>;

std::size_t end_of_name(std::string_view text, std::size_t at) {
  while (at < text.size() && is_letter_of_name(text[at])) ++at;
  return at;
}

std::string trimmed(std::string_view text) {
  const std::size_t from = text.find_first_not_of(" \t"), to = text.find_last_not_of(" \t");
  return from == std::string_view::npos ? std::string() : std::string(text.substr(from, to - from + 1));
}

/// The parts between the commas of "(a, f(b, c))", which begins at `at`; moves behind the bracket. None: it has no end.
std::optional<std::vector<std::string>> arguments_at(std::string_view text, std::size_t& at) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (std::size_t i = at; i < text.size(); ++i) {
    const char c = text[i];
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (depth == 0) {
      at = i + 1;
      for (std::string& part : parts) part = trimmed(part);
      return parts;
    }
    if (depth == 1 && c == ',')
      parts.emplace_back();
    else if (depth > 1 || c != '(')
      parts.back() += c;
  }
  return {};
}

std::string with_parameters(const Macro& macro, const std::vector<std::string>& arguments) {
  std::string out;
  for (std::size_t at = 0; at < macro.body.size();) {
    const std::size_t end = std::max(end_of_name(macro.body, at), at + 1);
    const std::string word = macro.body.substr(at, end - at);
    const auto found = std::ranges::find(macro.parameters, word);
    const auto which = static_cast<std::size_t>(found - macro.parameters.begin());
    out += found != macro.parameters.end() && which < arguments.size() ? arguments[which] : word;
    at = end;
  }
  return out;
}

std::string put_in(std::string_view text, const Macros& macros, int depth) {
  std::string out;
  for (std::size_t at = 0; at < text.size() && out.size() < largest_text;) {
    const std::size_t end = std::max(end_of_name(text, at), at + 1);
    const auto known = macros.find(std::string(text.substr(at, end - at)));
    if (known == macros.end() || depth == deepest) {
      out += text.substr(at, end - at), at = end;
      continue;
    }
    std::size_t behind = end;
    std::vector<std::string> arguments;
    if (known->second.takes_arguments) {
      while (behind < text.size() && std::isspace(static_cast<unsigned char>(text[behind])) != 0) ++behind;
      const auto found =
          behind < text.size() && text[behind] == '(' ? arguments_at(text, behind) : std::nullopt;
      if (!found) {
        out += text.substr(at, end - at), at = end;
        continue;
      }
      arguments = *found;
    }
    out += " " + put_in(with_parameters(known->second, arguments), macros, depth + 1) + " ", at = behind;
  }
  return out;
}

/// Of "NAME body" or "NAME(a, b) body".
void add_macro(std::string_view text, Macros& macros) {
  const std::size_t end = end_of_name(text, 0);
  std::size_t at = end;
  Macro macro;
  macro.takes_arguments = at < text.size() && text[at] == '(';
  if (macro.takes_arguments) {
    auto parameters = arguments_at(text, at);
    if (!parameters) return;
    macro.parameters = std::move(*parameters);
  }
  macro.body = trimmed(text.substr(at));
  macros.insert_or_assign(std::string(text.substr(0, end)), std::move(macro));
}

}  // namespace

std::string with_macros_put_in(const std::string& text) {
  Macros macros;
  std::string plain;
  for (const LogicalLine& line : logical_lines(text)) {
    const Directive directive = directive_of(line.text);
    if (directive.word == "define") add_macro(directive.rest, macros);
    if (directive.word.empty()) plain += line.text + "\n";
  }
  if (macros.empty()) return plain;
  std::string out = put_in(plain, macros, 0);
  return out.size() < largest_text ? out : plain;
}

}  // namespace gnomon::grade
