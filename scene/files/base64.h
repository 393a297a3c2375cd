// Bytes as text of 64 letters (RFC 4648, section 4), for data URIs.
#pragma once

#include <string>
#include <string_view>

namespace gnomon {

std::string base64(std::string_view bytes);

}  // namespace gnomon
