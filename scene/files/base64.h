// Bytes as text of 64 letters (RFC 4648, section 4), for data URIs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

std::string base64(std::string_view bytes);
/// None where a letter is not one of the 64. Padding at the end may be missing.
std::optional<std::vector<char>> from_base64(std::string_view text);

}  // namespace gnomon
