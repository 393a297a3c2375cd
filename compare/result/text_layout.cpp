#include "compare/result/text_layout.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "scene/base/expected.h"

namespace gnomon::compare {
namespace {

bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u;
}

// Bytes of the first `count` code points.
std::size_t prefix_bytes(std::string_view text, std::size_t count) {
  std::size_t i = 0;
  for (; i < text.size(); ++i)
    if (!continues(text[i]) && count-- == 0) break;
  return i;
}

// The last space at or before `limit` that a line may end at: not behind a digit, so that "95 ms" stays
// together.
std::size_t last_break(std::string_view text, std::size_t limit) {
  std::size_t cut = text.rfind(' ', limit);
  while (cut != std::string_view::npos && cut > 0 &&
         std::isdigit(static_cast<unsigned char>(text[cut - 1])) != 0)
    cut = text.rfind(' ', cut - 1);
  return cut;
}

}  // namespace

std::size_t text_width(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues(c); }));
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  // Only as far as a line goes: texts may be long.
  for (std::size_t limit = prefix_bytes(text, width); limit < text.size();
       limit = prefix_bytes(text, width)) {
    std::size_t cut = last_break(text, limit);
    const bool at_space = cut != std::string_view::npos && cut > 0;
    if (!at_space) cut = limit;
    lines.emplace_back(text.substr(0, cut));
    text.remove_prefix(at_space ? cut + 1 : cut);
  }
  lines.emplace_back(text);
  return lines;
}

std::string right_padded(std::string_view text, std::size_t width) {
  const std::size_t own = text_width(text);
  return std::string(text) + (own < width ? std::string(width - own, ' ') : std::string());
}

std::string joined_sentences(std::initializer_list<std::string_view> sentences) {
  std::string text;
  for (const std::string_view sentence : sentences) {
    if (!text.empty() && !sentence.empty()) text += ' ';
    text += sentence;
  }
  return text;
}

std::string spoken(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

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
