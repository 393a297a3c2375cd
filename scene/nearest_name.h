// Did you mean …?
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gnomon {

/// The known name nearest to `name`, if it is near enough to be a slip: at most a third of its letters
/// changed (an insertion, deletion, substitution or swap of neighbours counts as one). Empty when none is.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// "; did you mean NAME?", or nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> known);

}  // namespace gnomon
