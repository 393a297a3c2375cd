#include "compare/report/packing.h"

#include "compare/report/html.h"
#include "scene/files/deflate.h"

namespace gnomon::compare {
namespace {

std::string planes(const std::vector<std::uint32_t>& numbers, int bytes) {
  std::string out(numbers.size() * static_cast<std::size_t>(bytes), '\0');
  std::size_t o = 0;
  for (int plane = 0; plane < bytes; ++plane)
    for (const std::uint32_t n : numbers) out[o++] = static_cast<char>(n >> (8 * plane) & 0xffu);
  return out;
}

}  // namespace

std::string packed(std::vector<std::uint32_t> numbers, const PackOptions& options) {
  if (options.difference)
    for (std::size_t i = numbers.size(); i-- > 1;) numbers[i] -= numbers[i - 1];
  return base64(deflate(planes(numbers, options.bytes), options.level));
}

}  // namespace gnomon::compare
