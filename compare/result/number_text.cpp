#include "compare/result/number_text.h"

#include <fmt/core.h>

#include <array>
#include <cmath>

namespace gnomon::compare {
namespace {

// From here on three digits would round to a thousand, which "g" writes with an exponent.
constexpr double first_of_four_digits = 999.5;

}  // namespace

std::string grouped(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string percent(double fraction) {
  const double p = 100.0 * fraction;
  if (!std::isfinite(p)) return "unknown";
  if (p == 0.0) return "0 %";
  if (p > 0.0 && p < 0.001) return "less than 0.001 %";
  if (p > 99.99 && p < 100.0) return "more than 99.99 %";
  if (p == 100.0) return "100 %";
  if (p > 99.0) return fmt::format("{:.2f} %", p);
  return p < 1.0 ? fmt::format("{:.2g} %", p) : fmt::format("{:.1f} %", p);
}

std::string plain_number(double value) {
  if (std::isnan(value)) return "unknown";
  if (std::isinf(value)) return "unlimited";
  const double size = std::abs(value);
  if (size >= first_of_four_digits && size < 1e6) return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

std::string unsigned_number(double value) {
  if (value == 0.0) return "0";
  // Four decimals, or as many more as the first digit needs.
  const int decimals = value < 5e-5 ? static_cast<int>(std::ceil(-std::log10(value))) : 4;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string signed_number(double value) {
  if (value == 0.0) return "0";
  return (value < 0.0 ? "\u2212" : "+") + unsigned_number(std::abs(value));
}

std::string plain_number_up(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return plain_number(value);
  const bool whole = value >= first_of_four_digits && value < 1e6;
  const double digit = whole ? 1.0 : std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  for (double up = value;; up += digit)
    if (std::string text = plain_number(up); std::stod(text) >= value) return text;
}

std::string with_noun(const std::string& number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == "1" || number == "-1" ? "" : "s");
}

std::string counted(std::uint64_t count, std::string_view noun) {
  return with_noun(grouped(count), noun);
}

std::string texels_text(double texels, int digits) {
  const double size = std::abs(texels);
  if (size > 0.0 && size < 0.001) return "less than 0.001 texel";
  const std::string text =
      size < 99.5 ? fmt::format("{:.{}g}", texels, digits) : fmt::format("{:.0f}", texels);
  return size < 1.0 ? text + " texel" : with_noun(text, "texel");
}

std::string milliseconds(double ms) {
  if (!(ms >= 0.0)) return "not timed";
  if (ms < 10.0) return fmt::format("{:.2g} ms", ms);
  if (ms < 1000.0) return fmt::format("{:.0f} ms", ms);
  const double seconds = ms / 1000.0;
  return seconds < first_of_four_digits ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

namespace {

// "4.9 to 8.2 ms", "0 to 30 ms", "900 ms to 1.2 s".
std::string milliseconds_between(double low, double high) {
  std::string from = low > 0.0 ? milliseconds(low) : "0", to = milliseconds(high);
  const std::string unit = to.substr(to.find(' '));
  if (from.ends_with(unit)) from.resize(from.size() - unit.size());
  return from + " to " + to;
}

}  // namespace

std::string milliseconds(const TimeDifference& difference) {
  if (!difference.timed()) return "not timed";
  const std::string between = milliseconds_between(difference.low, difference.high);
  if (!difference.told) return between;
  const std::string middle = milliseconds(difference.median);
  return middle == milliseconds(difference.low) && middle == milliseconds(difference.high)
             ? middle
             : fmt::format("{} ({})", middle, between);
}

std::string byte_count(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> units{"bytes", "kB", "MB", "GB", "TB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= first_of_four_digits && unit + 1 < units.size(); ++unit) value /= 1000.0;
  return unit == 0 ? fmt::format("{} bytes", bytes) : fmt::format("{:.3g} {}", value, units[unit]);
}

}  // namespace gnomon::compare
