// Numbers are read with std::from_chars: no locale, nothing left over, nothing rounded twice.
#include "app/values.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>

namespace gnomon::app {

namespace {

tl::unexpected<Error> wrong(std::string_view reason, std::string_view got, std::string_view allowed) {
  return fail(ErrorKind::usage, fmt::format("{} (got {}, allowed {})", reason, got, allowed));
}

/// The whole text as a number, or nothing.
template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  if (text.starts_with("+-")) return std::nullopt;
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Takes a number's unit off its text: whether it had one.
bool take_texels(std::string_view& text) {
  for (const std::string_view unit : {std::string_view("texels"), std::string_view("texel")}) {
    if (!text.ends_with(unit)) continue;
    text.remove_suffix(unit.size());
    return true;
  }
  return false;
}

bool contains(const OptionRange& range, double value) {
  return std::isfinite(value) && value <= range.max &&
         (range.min_excluded ? value > range.min : value >= range.min);
}

}  // namespace

std::string number_text(double value) {
  return fmt::format("{}", value);
}

std::string range_text(const OptionRange& range) {
  return fmt::format("{}{} to {}", range.min_excluded ? "above " : "", range.min, range.max);
}

Expected<double> parse_number(std::string_view text, const OptionRange& range) {
  const std::optional<double> value = whole_number<double>(text);
  if (!value) return wrong("not a number", text, range_text(range));
  if (!contains(range, *value)) return wrong("out of range", text, range_text(range));
  return *value;
}

Expected<std::int64_t> parse_integer(std::string_view text, std::int64_t min, std::int64_t max) {
  const std::string allowed = fmt::format("{} to {}", min, max);
  const std::optional<std::int64_t> value = whole_number<std::int64_t>(text);
  if (!value) return wrong("not a whole number in range", text, allowed);
  if (*value < min || *value > max) return wrong("out of range", text, allowed);
  return *value;
}

Expected<std::uint64_t> parse_seed(std::string_view text) {
  const std::optional<std::uint64_t> value = whole_number<std::uint64_t>(text);
  if (!value) return wrong("not a whole number in range", text, fmt::format("0 to {}", UINT64_MAX));
  return *value;
}

Expected<ImageSize> parse_size(std::string_view text) {
  const std::string allowed = fmt::format("1x1 to {0}x{0}", max_image_side);
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return wrong("not of the form WIDTHxHEIGHT", text, allowed);
  const Expected<std::int64_t> width = parse_integer(text.substr(0, cross), 1, max_image_side);
  const Expected<std::int64_t> height = parse_integer(text.substr(cross + 1), 1, max_image_side);
  if (!width || !height) return wrong("not a picture size", text, allowed);
  return ImageSize{static_cast<int>(*width), static_cast<int>(*height)};
}

Expected<BiasValue> parse_bias(std::string_view text) {
  if (text == "auto") return BiasValue{1.0, raster::BiasUnit::automatic};
  std::string_view number = text;
  BiasValue bias;
  if (take_texels(number)) bias.unit = raster::BiasUnit::texel;
  const std::optional<double> value = whole_number<double>(number);
  if (!value || !contains(bias_range, *value)) {
    return wrong("not a bias", text,
                 "auto, or a finite number of world units, such as 0.02, or of texels, such as 0.5texel");
  }
  bias.constant = *value;
  return bias;
}

std::string bias_text(const raster::Bias& bias) {
  if (bias.unit == raster::BiasUnit::automatic) return "auto";
  return number_text(bias.constant) + (bias.unit == raster::BiasUnit::texel ? "texel" : "");
}

Expected<double> parse_share(std::string_view text) {
  const bool percent = text.ends_with('%');
  const std::optional<double> value = whole_number<double>(percent ? text.substr(0, text.size() - 1) : text);
  const double share = value ? *value / (percent ? 100.0 : 1.0) : -1.0;
  if (!contains({0.0, 1.0}, share)) return wrong("not a share", text, "0% to 100%, or 0 to 1");
  return share;
}

Expected<compare::Threshold> parse_threshold(std::string_view text) {
  using compare::ErrorMeasure;
  compare::Threshold out;
  std::string_view number = text;
  if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
    const std::string_view name = text.substr(0, colon);
    number.remove_prefix(colon + 1);
    for (const ErrorMeasure m : {ErrorMeasure::wrong, ErrorMeasure::mean, ErrorMeasure::flip,
                                 ErrorMeasure::edge, ErrorMeasure::shimmer})
      if (name == measure_name(m)) out.measure = m;
    if (out.measure == ErrorMeasure::wrong_and_mean) return wrong("not a limit", text, threshold_range);
  }
  if (out.measure == ErrorMeasure::edge) {
    constexpr OptionRange texels{0.0, 1e6};
    take_texels(number);
    const std::optional<double> value = whole_number<double>(number);
    if (!value || !contains(texels, *value)) return wrong("not a limit", text, "edge: and texels, 0 to 1e6");
    out.limit = *value;
    return out;
  }
  if (out.measure == ErrorMeasure::shimmer) {
    const Expected<double> flips = parse_number(std::string(number), {0.0, 1e9});
    if (!flips) return wrong("not a limit", text, "shimmer: and flips per receiver and second, 0 to 1e9");
    out.limit = *flips;
    return out;
  }
  const Expected<double> share = parse_share(number);
  if (!share) return wrong("not a limit", text, threshold_range);
  out.limit = *share;
  out.bare_one = out.limit == 1.0 && !number.ends_with('%');
  return out;
}

Expected<std::optional<double>> parse_exposure(std::string_view text) {
  if (text == "auto") return std::optional<double>{};
  const std::optional<double> value = whole_number<double>(text);
  if (!value || !contains(exposure_range, *value)) {
    return wrong("not an exposure", text, "auto, or a linear factor above 0");
  }
  return value;
}

}  // namespace gnomon::app
