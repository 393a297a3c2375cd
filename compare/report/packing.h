// Arrays of integers as short text for the page: deflated planes of bytes, in base64. The page's twin is
// page/src/packed.ts.
//
// A number is taken modulo 2^(8 bytes). `difference` first replaces each number by its difference from the
// one before it, which suits what changes little from pixel to pixel. Then all lowest bytes, all second bytes
// and so on, compressed as one zlib stream (RFC 1950).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon::compare {

struct PackOptions {
  int bytes = 4;  ///< of each number: 1, 2 or 4
  bool difference = false;
  int level = 3;  ///< of deflate(): 6 takes twice the time for a few percent
};

std::string packed(std::vector<std::uint32_t> numbers, const PackOptions& options);

}  // namespace gnomon::compare
