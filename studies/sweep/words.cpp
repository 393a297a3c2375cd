#include "studies/sweep/headline.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "compare/comparison.h"
#include "compare/ladder/labels.h"

namespace gnomon::studies {

std::string axis_words(std::string_view axis) {
  std::string words(axis);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string value_words(std::string_view value) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc()) return axis_words(value);
  const auto length = static_cast<std::size_t>(end - value.data());
  const std::size_t point = value.substr(0, length).find('.');
  constexpr std::size_t most_decimals = 4;
  if (point == std::string_view::npos || length - point - 1 <= most_decimals) return std::string(value);
  return fmt::format("{:.4g}{}", number, value.substr(length));
}

std::string label_words_of(std::string_view key) {
  for (std::size_t k = 1; k <= compare::class_count; ++k)
    if (const auto label = static_cast<compare::Label>(k); compare::label_name(label) == key)
      return std::string(compare::label_text(label).name);
  return std::string(key);
}

}  // namespace gnomon::studies
