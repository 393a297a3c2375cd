// SHA-256 against the vectors of FIPS 180-4's examples and NIST's CAVP.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/files/encodings.h"

namespace gnomon {
namespace {

TEST(Sha256, KnownDigests) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// Every length around the two block boundaries pads differently; a digest must never repeat.
TEST(Sha256, LengthsAroundABlockDiffer) {
  std::vector<std::string> digests;
  for (std::size_t n = 50; n < 140; ++n) digests.push_back(sha256_hex(std::string(n, 'x')));
  std::sort(digests.begin(), digests.end());
  EXPECT_EQ(std::unique(digests.begin(), digests.end()), digests.end());
}

}  // namespace
}  // namespace gnomon
