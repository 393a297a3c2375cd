// How a sweep speaks of its axes, values and labels: in words, not in keys of sweep.jsonl.
#pragma once

#include <string>
#include <string_view>

namespace gnomon::compare {

/// "map_size" -> "map size".
std::string axis_words(std::string_view axis);
/// A value as people read it: a number with five decimals or more at four significant digits, its unit behind it
/// ("0.00869565217391" -> "0.008696"); words without underscores. Commands and CSV have it in full.
std::string value_words(std::string_view value);
/// A label by its key of result.json: "peter_panning" -> "peter-panning"; empty for an empty key.
std::string label_words_of(std::string_view key);

}  // namespace gnomon::compare
