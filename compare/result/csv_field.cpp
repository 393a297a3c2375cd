#include "compare/result/csv_field.h"

#include <string_view>

#include "scene/base/expected.h"

namespace gnomon::compare {

std::string csv_field(const std::string& field) {
  const std::string text = one_line(field);
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string csv_name(const std::string& name) {
  constexpr std::string_view begins_formula = "=+-@\t\r", number = "0123456789.,+-eE";
  const bool is_formula = !name.empty() && begins_formula.find(name.front()) != std::string_view::npos;
  return is_formula && name.find_first_not_of(number) != std::string::npos ? "'" + name : name;
}

}  // namespace gnomon::compare
