#include "app/options/values.h"

#include <fmt/core.h>

#include <cmath>

#include "compare/result/figures.h"

namespace gnomon::app {

namespace {

constexpr std::pair<std::string_view, ImageSize> named_sizes[] = {{"720p", {1280, 720}},
                                                                  {"1080p", {1920, 1080}},
                                                                  {"1440p", {2560, 1440}},
                                                                  {"4k", {3840, 2160}},
                                                                  {"8k", {7680, 4320}}};

std::string size_names(std::string_view separator) {
  std::string text;
  for (const auto& [name, size] : named_sizes)
    text += (text.empty() ? "" : std::string(separator)) + std::string(name);
  return text;
}

}  // namespace

std::string size_choices() {
  return fmt::format("{1}; or pixels, 1x1 to {0}x{0}", max_image_side, size_names(" or "));
}

Expected<ImageSize> parse_size(std::string_view text) {
  for (const auto& [name, size] : named_sizes)
    if (name == text) return size;
  const std::string allowed = fmt::format("1x1 to {0}x{0}, or {1}", max_image_side, size_names(", "));
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return wrong_value("not of the form WIDTHxHEIGHT", text, allowed);
  const Expected<std::int64_t> width = parse_integer(text.substr(0, cross), 1, max_image_side);
  const Expected<std::int64_t> height = parse_integer(text.substr(cross + 1), 1, max_image_side);
  if (!width || !height) return wrong_value("not a picture size", text, allowed);
  return ImageSize{static_cast<int>(*width), static_cast<int>(*height)};
}

Expected<double> parse_share(std::string_view text) {
  const bool percent = text.ends_with('%');
  const std::optional<double> value = whole_number(percent ? text.substr(0, text.size() - 1) : text);
  const double share = value ? *value / (percent ? 100.0 : 1.0) : -1.0;
  if (!OptionRange{0.0, 1.0}.contains(share))
    return wrong_value("not a share", text, "0% to 100%, or 0 to 1");
  return share;
}

Expected<compare::Threshold> parse_threshold(std::string_view text, const compare::Figure& plain) {
  compare::Threshold out{&plain};
  std::string_view number = text;
  if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
    out.measure = compare::find_measure(text.substr(0, colon));
    if (out.measure == nullptr) return wrong_value("not a limit", text, compare::threshold_range(false));
    number.remove_prefix(colon + 1);
  }
  const compare::Figure& measure = *out.measure;
  if (measure.unit != "share") {
    if (measure.unit == "texels") consume_texels(number);
    const std::optional<double> value = whole_number(number);
    if (!value || !OptionRange{0.0, *whole_number(measure.measure.most)}.contains(*value))
      return wrong_value(
          "not a limit", text,
          fmt::format("{}: and {}, 0 to {}", measure.measure.name, measure.unit, measure.measure.most));
    out.limit = *value;
    return out;
  }
  const Expected<double> share = parse_share(number);
  if (!share) return wrong_value("not a limit", text, compare::threshold_range(false));
  if (*share == 1.0 && measure.form() == compare::FigureForm::percent && !number.ends_with('%'))
    return wrong_value("1 is all, and may be meant as one per cent", text, "1% or 0.01, or 100%");
  out.limit = *share;
  return out;
}

Expected<std::optional<double>> parse_exposure(std::string_view text) {
  if (text == "auto") return std::optional<double>{};
  const std::optional<double> value = whole_number(text);
  if (!value || !exposure_range.contains(*value)) {
    return wrong_value("not an exposure", text, "auto, or a linear factor above 0");
  }
  return value;
}

}  // namespace gnomon::app
