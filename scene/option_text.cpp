// Numbers are read with std::from_chars: no locale, nothing left over, nothing rounded twice.
#include "scene/option_text.h"

#include <fmt/core.h>

#include <charconv>

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

bool take_texels(std::string_view& text) {
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

}  // namespace gnomon
