// PLY files: ascii and both binary orders.
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gnomon::fuzz::load_as(".ply", data, size);
  return 0;
}

namespace {

std::string binary(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto word = [&](std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * (big_endian ? 3 - i : i));
  };
  constexpr std::uint32_t one = 0x3f800000;  // 1.0f
  for (const std::uint32_t value : {0u, 0u, 0u, one, 0u, 0u, 0u, one, 0u}) word(value);
  bytes += '\3';
  for (const std::uint32_t corner : {0u, 1u, 2u}) word(corner);
  return bytes;
}

}  // namespace

std::vector<std::string> gnomon::fuzz::seeds() {
  return {
      "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty double x\nproperty double y\n"
      "property double z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
      "property list uchar uint vertex_indices\nend_header\n"
      "0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty ushort green\nproperty float blue\nproperty uchar alpha\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 0 1 9\n1 0 0 1 65535 0.5 0\n0 1 0 7 8 -1 255\n3 0 1 2\n",
      binary(false), binary(true)};
}
