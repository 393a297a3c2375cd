#include "studies/sweep/axis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "scene/files/read_file.h"

namespace gnomon::studies {
namespace {

tl::unexpected<Error> wrong(std::string_view reason, std::string_view got, std::string_view allowed) {
  return fail(ErrorKind::usage, fmt::format("{} (got {}, allowed {})", reason, got, allowed));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0;;) {
    const std::size_t end = text.find(separator, start);
    parts.push_back(text.substr(start, end - start));
    if (end == std::string_view::npos) return parts;
    start = end + 1;
  }
}

// One end of a range: its numbers, and the unit that follows the last one.
struct RangeEnd {
  std::vector<double> numbers;
  std::string unit;
};

std::optional<RangeEnd> parse_end(std::string_view text, bool compound) {
  RangeEnd end;
  std::vector<std::string_view> parts = compound ? split(text, ',') : std::vector{text};
  std::string_view& last = parts.back();
  // "1e3" is a number as a whole; only what is left after the longest number is a unit.
  if (last.starts_with("+-")) return std::nullopt;
  double value = 0.0;
  const std::string_view digits = last.starts_with('+') ? last.substr(1) : last;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{}) return std::nullopt;
  end.unit.assign(stop, digits.data() + digits.size());
  last = digits.substr(0, digits.size() - end.unit.size());
  for (const std::string_view part : parts) {
    const auto number = parse_decimal(part);
    if (!number) return std::nullopt;
    end.numbers.push_back(*number);
  }
  return end;
}

std::string value_text(const std::vector<double>& numbers, const std::string& unit) {
  // A negative zero reads back as zero.
  std::vector<double> clean = numbers;
  for (double& number : clean) number += 0.0;
  return fmt::format("{}{}", fmt::join(clean, ","), unit);
}

// In a product, the same value twice would make the same cells twice.
Expected<void> check_distinct(const Axis& axis) {
  std::vector<std::string> sorted = axis.values;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice == sorted.end()) return {};
  return fail(ErrorKind::usage, fmt::format("--{}: a value is there twice (got {}, allowed each value once)",
                                            axis.name, *twice));
}

// Twelve digits: the third of six steps to 0.1 is 0.05, not 0.05000000000000001.
double rounded(double value) {
  return parse_decimal(fmt::format("{:.12g}", value)).value_or(value);
}

constexpr std::string_view range_form = "START:END:COUNT or START:END:xFACTOR";

Expected<std::vector<std::string>> linear_values(std::string_view text, const RangeEnd& from,
                                                 const RangeEnd& to, std::string_view count_text) {
  const auto count = parse_decimal(count_text);
  if (!count || *count < 2.0 || *count > double(max_axis_values) || *count != std::floor(*count))
    return wrong("the count of a range", text, fmt::format("2 to {} values", max_axis_values));
  const auto steps = static_cast<std::size_t>(*count) - 1;
  std::vector<std::string> values;
  for (std::size_t i = 0; i <= steps; ++i) {
    std::vector<double> numbers;
    for (std::size_t k = 0; k < from.numbers.size(); ++k) {
      const double a = from.numbers[k], b = to.numbers[k];
      numbers.push_back(i == steps ? b : rounded(a + (b - a) * (double(i) / double(steps))));
    }
    values.push_back(value_text(numbers, to.unit));
  }
  return values;
}

Expected<std::vector<std::string>> factor_values(std::string_view text, const RangeEnd& from,
                                                 const RangeEnd& to, std::string_view factor_text) {
  const auto factor = parse_decimal(factor_text.substr(1));
  if (!factor || !(*factor > 1.0)) return wrong("the factor of a range", text, "a number above 1");
  if (from.numbers.size() != 1)
    return wrong("values of several numbers have no ×-range", text, "START:END:COUNT");
  const double start = from.numbers[0], end = to.numbers[0];
  if (!(start > 0.0) || !(end >= start)) return wrong("the ends of a ×-range", text, "0 < START <= END");
  std::vector<std::string> values;
  // Half a step of rounding must not lose the end.
  for (int i = 0; start * std::pow(*factor, i) <= end * (1.0 + 1e-12); ++i) {
    if (values.size() == max_axis_values)
      return wrong("too many values", text, fmt::format("up to {}", max_axis_values));
    values.push_back(value_text({std::min(end, rounded(start * std::pow(*factor, i)))}, to.unit));
  }
  return values;
}

Expected<std::vector<std::string>> range_values(std::string_view text, bool compound) {
  const std::vector<std::string_view> parts = split(text, ':');
  if (parts.size() != 3) return wrong("not a range", text, range_form);
  const auto from = parse_end(parts[0], compound), to = parse_end(parts[1], compound);
  const bool units_agree = from && to && (from->unit.empty() || from->unit == to->unit);
  if (!units_agree || from->numbers.size() != to->numbers.size())
    return wrong("the ends of a range", text, "two numbers of one unit");
  return parts[2].starts_with('x') ? factor_values(text, *from, *to, parts[2])
                                   : linear_values(text, *from, *to, parts[2]);
}

}  // namespace

Expected<std::vector<std::string>> expand_values(std::string_view text, ValueKind kind) {
  const bool compound = kind == ValueKind::numbers;
  std::vector<std::string> values;
  for (const std::string_view part : split(text, compound ? '/' : ',')) {
    if (part.empty()) return wrong("an empty value", text.empty() ? "nothing" : text, "a list without gaps");
    if (kind == ValueKind::word || part.find(':') == std::string_view::npos) {
      values.emplace_back(part);
      continue;
    }
    const auto range = range_values(part, compound);
    if (!range) return fail(range.error());
    values.insert(values.end(), range->begin(), range->end());
  }
  if (values.size() > max_axis_values)
    return wrong("too many values", text, fmt::format("up to {}", max_axis_values));
  return values;
}

Expected<Grid> Grid::make(std::vector<Axis> axes, bool zip) {
  Grid grid;
  grid.zip_ = zip;
  const Axis* longest = nullptr;
  for (const Axis& axis : axes) {
    const std::size_t count = axis.values.size();
    if (auto distinct = check_distinct(axis); !zip && !distinct) return fail(distinct.error());
    if (zip && count > 1) {
      if (longest != nullptr && longest->values.size() != count)
        return fail(ErrorKind::usage,
                    fmt::format("--zip: axes of one length are needed (--{} has {} values, --{} has {})",
                                longest->name, longest->values.size(), axis.name, count));
      longest = &axis;
      grid.cells_ = count;
    } else if (!zip) {
      grid.cells_ *= count;
    }
    if (grid.cells_ > max_cells)
      return fail(ErrorKind::usage, fmt::format("too many cells (allowed up to {})", max_cells));
  }
  grid.axes_ = std::move(axes);
  return grid;
}

std::vector<std::size_t> Grid::position(std::size_t cell) const {
  std::vector<std::size_t> at(axes_.size(), 0);
  for (std::size_t k = axes_.size(); k-- > 0;) {
    const std::size_t count = axes_[k].values.size();
    at[k] = zip_ ? (count > 1 ? cell : 0) : cell % count;
    if (!zip_) cell /= count;
  }
  return at;
}

}  // namespace gnomon::studies
