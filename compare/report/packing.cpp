#include "compare/report/packing.h"

#include <zlib.h>

#include <cassert>

#include "compare/report/html.h"

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
  const std::string raw = planes(numbers, options.bytes);
  uLongf length = compressBound(static_cast<uLong>(raw.size()));
  std::string deflated(length, '\0');
  // compress2 can only fail for a bad level or too small a buffer: neither can be here.
  [[maybe_unused]] const int state =
      compress2(reinterpret_cast<Bytef*>(deflated.data()), &length,
                reinterpret_cast<const Bytef*>(raw.data()), static_cast<uLong>(raw.size()), options.level);
  assert(state == Z_OK);
  deflated.resize(length);
  return base64(deflated);
}

}  // namespace gnomon::compare
