// Numbers are read with std::from_chars: no locale, nothing left over, nothing rounded twice.
#include "scene/base/option_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <vector>

namespace gnomon {

namespace {

template <class Number>
std::optional<Number> whole(std::string_view text) {
  if (text.starts_with("+-")) return std::nullopt;
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

tl::unexpected<Error> wrong_value(std::string_view reason, std::string_view got, std::string_view allowed) {
  return fail(ErrorKind::usage, fmt::format("{} (got {}, allowed {})", reason, got, allowed));
}

std::optional<double> whole_number(std::string_view text) {
  return whole<double>(text);
}

bool consume_texels(std::string_view& text) {
  for (const std::string_view unit : {std::string_view("texels"), std::string_view("texel")}) {
    if (!text.ends_with(unit)) continue;
    text.remove_suffix(unit.size());
    return true;
  }
  return false;
}

std::string number_text(double value) {
  return fmt::format("{}", value);
}

std::string range_text(const OptionRange& range) {
  return fmt::format("{}{} to {}", range.min_excluded ? "above " : "", range.min, range.max);
}

Expected<double> parse_number(std::string_view text, const OptionRange& range) {
  const std::optional<double> value = whole<double>(text);
  if (!value) return wrong_value("not a number", text, range_text(range));
  if (!range.contains(*value)) return wrong_value("out of range", text, range_text(range));
  return *value;
}

Expected<std::int64_t> parse_integer(std::string_view text, std::int64_t min, std::int64_t max) {
  const std::string allowed = fmt::format("{} to {}", min, max);
  const std::optional<std::int64_t> value = whole<std::int64_t>(text);
  if (!value) return wrong_value("not a whole number in range", text, allowed);
  if (*value < min || *value > max) return wrong_value("out of range", text, allowed);
  return *value;
}

Expected<std::uint64_t> parse_unsigned(std::string_view text) {
  const std::optional<std::uint64_t> value = whole<std::uint64_t>(text);
  if (!value) return wrong_value("not a whole number in range", text, fmt::format("0 to {}", UINT64_MAX));
  return *value;
}

namespace {

/// ASCII alone, whatever the locale.
char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_same_letter(char a, char b) {
  return lower_case(a) == lower_case(b);
}

}  // namespace

bool is_same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same_letter);
}

// Optimal string alignment distance: Damerau 1964, in the three-row form of Hyyrö 2003, section 2.

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = previous[j - 1] + (is_same_letter(a[i - 1], b[j - 1]) ? 0 : 1);
      current[j] = std::min({substituted, previous[j] + 1, current[j - 1] + 1});
      const bool swapped =
          i > 1 && j > 1 && is_same_letter(a[i - 1], b[j - 2]) && is_same_letter(a[i - 2], b[j - 1]);
      if (swapped) current[j] = std::min(current[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

}  // namespace

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known) {
  constexpr std::size_t longest_name = 64;  // none is longer, and the distance is quadratic
  std::string_view best;
  if (name.size() > longest_name) return best;
  std::size_t best_distance = std::max<std::size_t>(name.size() / 3, 1) + 1;
  for (const std::string_view candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance) best = candidate, best_distance = distance;
  }
  return best;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> known) {
  const std::string_view nearest = nearest_name(name, known);
  return nearest.empty() ? std::string() : "; did you mean " + std::string(nearest) + "?";
}

std::string shell_quoted(std::string_view word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace gnomon
