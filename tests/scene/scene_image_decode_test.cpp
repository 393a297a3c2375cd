// PNG and JPEG files of every kind, read as OpenImageIO reads them: to the last bit.
#include <fmt/format.h>
#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <random>

#include "scene/files/encodings.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/image_library.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

void expect_as_open_image_io(const DecodedImage& own, const std::string& bytes, const std::string& format) {
  const auto library = image_library();
  ASSERT_TRUE(library);
  const auto other = (*library)->decode("other", bytes, format, max_image_side);
  ASSERT_TRUE(other) << other.error().message();
  EXPECT_EQ(own.size, other->size);
  EXPECT_EQ(own.channels.size(), other->channels.size());
  EXPECT_TRUE(own.bytes == other->bytes);
}

struct PngKind {
  int type, depth;
  std::size_t samples;
  std::string transparency;  ///< tRNS; empty: none
};

/// All of the PNG specification's table 11.1, with a transparent colour where there may be one.
std::vector<PngKind> png_kinds() {
  std::vector<PngKind> kinds;
  for (const int depth : {1, 2, 4, 8, 16})
    for (const std::string& transparency : {std::string(), std::string("\0\1", 2)}) {
      kinds.push_back({0, depth, 1, transparency});
      if (depth <= 8) kinds.push_back({3, depth, 1, transparency});
    }
  for (const int depth : {8, 16}) {
    kinds.push_back({2, depth, 3, {}});
    kinds.push_back({2, depth, 3, std::string("\0\1\0\2\0\3", 6)});
    kinds.push_back({4, depth, 2, {}});
    kinds.push_back({6, depth, 4, {}});
  }
  return kinds;
}

/// Bytes of the scan lines with their filters, of a picture or of its seven interlaced ones.
std::size_t scanline_bytes(const PngKind& kind, std::size_t width, std::size_t height, bool interlaced) {
  const auto pass = [&](std::size_t w, std::size_t h) {
    return w == 0 ? 0 : h * (1 + (w * kind.samples * std::size_t(kind.depth) + 7) / 8);
  };
  if (!interlaced) return pass(width, height);
  const auto part = [&](std::size_t x, std::size_t dx, std::size_t y, std::size_t dy) {
    return pass((width + dx - 1 - x) / dx, (height + dy - 1 - y) / dy);
  };
  return part(0, 8, 0, 8) + part(4, 8, 0, 8) + part(0, 4, 4, 8) + part(2, 4, 0, 4) + part(0, 2, 2, 4) +
         part(1, 2, 0, 2) + part(0, 1, 1, 2);
}

/// Bytes of 0 to 4 are filters wherever one is due, and make colours of all kinds once they are undone.
std::string noise(std::size_t count) {
  std::mt19937 random(7);
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() % 5);
  return bytes;
}

std::string png(const PngKind& kind, int width, int height, bool interlaced) {
  const std::string header{char(kind.depth), char(kind.type), 0, 0, char(interlaced)};
  std::string file =
      "\x89PNG\r\n\x1a\n" + test::png_chunk("IHDR", test::big_endian(std::uint32_t(width)) +
                                                        test::big_endian(std::uint32_t(height)) + header);
  // A linear gamma, which neither applies: models' colours are what is stored.
  file += test::png_chunk("gAMA", test::big_endian(100000));
  std::string palette;
  for (int i = 0; i < 3 << kind.depth; ++i) palette += static_cast<char>(37 * i);
  if (kind.type == 3) file += test::png_chunk("PLTE", palette);
  if (!kind.transparency.empty()) file += test::png_chunk("tRNS", kind.transparency);
  const std::size_t bytes = scanline_bytes(kind, std::size_t(width), std::size_t(height), interlaced);
  return file + test::png_chunk("IDAT", deflate(noise(bytes), 6)) + test::png_chunk("IEND", "");
}

TEST(ImageDecode, EveryKindOfPng) {
  for (const PngKind& kind : png_kinds())
    for (const bool interlaced : {false, true}) {
      SCOPED_TRACE(fmt::format("type {}, {} bits, {}{}", kind.type, kind.depth,
                               interlaced ? "interlaced, " : "",
                               kind.transparency.empty() ? "opaque" : "tRNS"));
      const std::string bytes = png(kind, 13, 11, interlaced);
      const auto own = decode_png("own", bytes);
      ASSERT_TRUE(own) << own.error().message();
      expect_as_open_image_io(*own, bytes, "png");
    }
}

TEST(ImageDecode, APngIsWholeOrAnError) {
  const std::string whole = png({2, 8, 3, {}}, 13, 11, false);
  for (std::size_t keep = 8; keep < whole.size(); ++keep) {
    const auto cut = decode_png("a.png", whole.substr(0, keep));
    ASSERT_FALSE(cut) << keep;
    EXPECT_EQ(cut.error().message(), "a.png: the PNG file is cut off") << keep;
  }
  std::string damaged = whole;
  damaged[whole.size() - 14] ^= 1;
  EXPECT_EQ(decode_png("a.png", damaged).error().message(),
            "a.png: the PNG file is damaged: IDAT: CRC error");
}

std::string jpeg(int subsampling, int flags, int format = TJPF_RGB) {
  constexpr int width = 61, height = 45;
  std::mt19937 random(7);
  std::vector<unsigned char> pixels(std::size_t(width * height * tjPixelSize[format]));
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = static_cast<unsigned char>((i / 40) % 200 + random() % 56);
  const std::unique_ptr<void, decltype(&tjDestroy)> coder(tjInitCompress(), &tjDestroy);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  EXPECT_EQ(
      tjCompress2(coder.get(), pixels.data(), width, 0, height, format, &out, &size, subsampling, 80, flags),
      0);
  const std::string bytes(reinterpret_cast<const char*>(out), size);
  tjFree(out);
  return bytes;
}

TEST(ImageDecode, EveryKindOfJpeg) {
  for (const int subsampling : {TJSAMP_444, TJSAMP_422, TJSAMP_420, TJSAMP_440, TJSAMP_GRAY})
    for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
      SCOPED_TRACE(fmt::format("subsampling {}, flags {}", subsampling, flags));
      const std::string bytes = jpeg(subsampling, flags);
      const auto own = decode_jpeg("own", bytes);
      ASSERT_TRUE(own) << own.error().message();
      ASSERT_TRUE(*own);
      expect_as_open_image_io(**own, bytes, "jpeg");
    }
}

TEST(ImageDecode, OfCmykOpenImageIoIsAsked) {
  const std::string bytes = jpeg(TJSAMP_444, 0, TJPF_CMYK);
  const auto own = decode_jpeg("own", bytes);
  ASSERT_TRUE(own) << own.error().message();
  EXPECT_FALSE(*own);
  const auto texture = read_texture_bytes("own", bytes, true);
  ASSERT_TRUE(texture) << texture.error().message();
  EXPECT_EQ(texture->size, (ImageSize{61, 45}));
  EXPECT_EQ(texture->texels[0].a, 255);
}

// Bytes between the segments are no fault of the picture.
TEST(ImageDecode, AJpegThatIsWarnedOfIsRead) {
  std::string bytes = jpeg(TJSAMP_444, 0);
  const std::size_t end = bytes.size() - 2;
  bytes.insert(end, "stray");
  EXPECT_TRUE(decode_jpeg("a.jpg", bytes));
  const auto damaged = decode_jpeg("a.jpg", bytes.substr(0, 30) + "\xff\xda\xff\xd9");
  EXPECT_FALSE(damaged);
}

// SHA-256 against the vectors of FIPS 180-4's examples and NIST's CAVP.
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
