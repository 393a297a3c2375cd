// SHA-256 (FIPS 180-4), so that a report can say which file it was made from.
#pragma once

#include <string>
#include <string_view>

namespace gnomon {

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace gnomon
