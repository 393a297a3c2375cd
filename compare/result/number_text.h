// How numbers are written for people: one policy for the summary, the verdict and the report page.
// Programs read result.json, which holds every number in full.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "scene/base/time_difference.h"

namespace gnomon::compare {

/// 1086177 -> "1,086,177".
std::string grouped(std::uint64_t count);
/// A share in [0, 1] with two or three significant digits: "4.1 %", "0.043 %", "43.6 %". Never rounds a share
/// that is neither none nor all to "0 %" or "100 %": those are "less than 0.001 %" and "more than 99.99 %".
std::string percent(double fraction);
/// Below this share, 0.01 %, a count says more than a percentage.
inline constexpr double few_fraction = 1e-4;
/// Three significant digits, no exponent between 1e-4 and 1e6; "unlimited" for infinities.
std::string plain_number(double value);
/// With its sign, four decimals or as many as its first digit needs, and a true zero: "+0.0120", "0",
/// "−0.00002".
std::string signed_number(double value);
/// Writes a size, without a sign.
std::string unsigned_number(double value);
/// Returns a number that is not less than `value`, which is above 0, as plain_number() writes it: what is promised to hold it.
std::string plain_number_up(double value);
/// "1 world unit", "0.04 world units": a number as it is printed, and its noun.
std::string with_noun(const std::string& number, std::string_view noun);
/// "1 shape", "1,024 triangles".
std::string counted(std::uint64_t count, std::string_view noun);
/// "0.8 texel", "1 texel", "1.6 texels": with so many digits, up to 99.
std::string texels_text(double texels, int digits = 2);
/// "12 ms", "0.42 ms", "1.9 s", "3723 s"; "not timed" for a negative value.
std::string milliseconds(double ms);
/// "7.1 ms (4.9 to 8.2 ms)"; where the runs do not tell it from nothing, the interval alone: "0 to 30 ms".
std::string milliseconds(const TimeDifference& difference);
/// "16.8 MB" (powers of ten).
std::string byte_count(std::uint64_t bytes);

}  // namespace gnomon::compare
