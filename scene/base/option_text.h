// The text of numbers that a user sets: how they are read, checked against their range, and written again. Errors are
// ErrorKind::usage with a reason that ends in "(got X, allowed Y)".
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/base/expected.h"

namespace gnomon {

/// The allowed values of a number, both ends included unless `min_excluded`.
struct OptionRange {
  double min, max;
  bool min_excluded = false;

  bool contains(double value) const {
    return std::isfinite(value) && value <= max && (min_excluded ? value > min : value >= min);
  }
};
std::string range_text(const OptionRange& range);  ///< "0 to 1000", "above 0 to 1e6"
std::string number_text(double value);             ///< shortest text that reads back as the same number

/// "REASON (got GOT, allowed ALLOWED)".
tl::unexpected<Error> wrong_value(std::string_view reason, std::string_view got, std::string_view allowed);

/// The whole text as a number, or nothing.
std::optional<double> whole_number(std::string_view text);
/// Takes the unit "texel" or "texels" off a number's text; returns whether the text had one.
bool consume_texels(std::string_view& text);

/// A finite decimal number. NaN and infinities are errors.
Expected<double> parse_number(std::string_view text, const OptionRange& range);
Expected<std::int64_t> parse_integer(std::string_view text, std::int64_t min, std::int64_t max);
/// An unsigned 64-bit integer.
Expected<std::uint64_t> parse_unsigned(std::string_view text);

/// The word as a POSIX shell needs it typed: itself where it is plain, else in single quotes.
std::string shell_quoted(std::string_view word);

/// Whether both are the same word but for the case of their (ASCII) letters.
bool is_same_word(std::string_view a, std::string_view b);

// Did you mean …?

/// The known name nearest to `name`, if it is near enough to be a slip: at most a third of its letters
/// changed. An insertion, deletion, substitution or swap of neighbours counts as one, another case of a letter
/// as none. Empty when none is.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// "; did you mean NAME?", or nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> known);

}  // namespace gnomon
