// PNG and JPEG files of every kind, and EXR files of the usual ones, read as OpenImageIO reads them: to the last bit.
#include <fmt/format.h>
#include <turbojpeg.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <random>

#include "scene/files/encodings.h"
#include "scene/files/pictures/exr_decode.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/image_library.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

void expect_as_open_image_io(const DecodedImage& own, const std::string& bytes, const std::string& format) {
  const auto library = image_library();
  ASSERT_TRUE(library);
  const auto other = (*library)->decode("other", bytes, format, max_image_side, {});
  ASSERT_TRUE(other) << other.error().message();
  EXPECT_EQ(own.size, other->size);
  EXPECT_EQ(own.channels.size(), other->channels.size());
  EXPECT_TRUE(own.bytes == other->bytes);
}

void expect_channels_as_open_image_io(const ChannelImage& own, const std::string& path) {
  const auto library = image_library();
  ASSERT_TRUE(library);
  const auto other = (*library)->read(path, max_image_side, DecodeAs::floats, {});
  ASSERT_TRUE(other) << other.error().message();
  EXPECT_EQ(own.size, other->size);
  ASSERT_EQ(own.channels.size(), other->channels.size());
  for (std::size_t c = 0; c < other->channels.size(); ++c) {
    const Channel* channel = &own.channels[c];
    ASSERT_EQ(channel->name, other->channels[c]);
    for (std::size_t i = 0; i < channel->values.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint32_t>(channel->values[i]),
                std::bit_cast<std::uint32_t>(other->floats[i * other->channels.size() + c]))
          << other->channels[c] << " " << i;
  }
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

/// Floats as judging reads them, of 8 and of 16 bits.
TEST(ImageDecode, APngAsFloats) {
  const TemporaryFolder folder;
  for (const PngKind& kind : png_kinds()) {
    SCOPED_TRACE(fmt::format("type {}, {} bits", kind.type, kind.depth));
    const std::string path = folder.put("a.png", png(kind, 13, 11, false));
    const auto own = read_channels(path);
    ASSERT_TRUE(own) << own.error().message();
    expect_channels_as_open_image_io(*own, path);
  }
}

struct ExrKind {
  char compression;  ///< 0 none, 2 ZIP of one row, 3 ZIP of 16
  int value_bytes;   ///< 2 halves, 4 floats
};

template <class Number>
std::string little_endian(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string exr_attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + little_endian(std::int32_t(value.size())) + value;
}

/// What ZIP packs, said as the format says it: even bytes, odd bytes, differences.
std::string zipped(const std::string& raw) {
  std::string bytes;
  for (const std::size_t first : {0, 1})
    for (std::size_t i = first; i < raw.size(); i += 2) bytes += raw[i];
  std::string out = bytes.substr(0, 1);
  for (std::size_t i = 1; i < bytes.size(); ++i) out += static_cast<char>(bytes[i] - bytes[i - 1] + 128);
  return deflate(out, 6);
}

/// Four channels whose window begins at row 3 and column -2, with blocks from the last to the first.
std::string exr(const ExrKind& kind, std::int32_t width, std::int32_t height) {
  const std::string field = little_endian(std::int32_t(kind.value_bytes == 2 ? 1 : 2)) +
                            little_endian(std::int32_t{0}) + little_endian(std::int32_t{1}) +
                            little_endian(std::int32_t{1});
  std::string channels;
  for (const char* name : {"A", "B", "G", "R"}) channels += std::string(name) + '\0' + field;
  const std::string window = little_endian(std::int32_t{-2}) + little_endian(std::int32_t{3}) +
                             little_endian(width - 3) + little_endian(height + 2);
  const std::string one = little_endian(1.0f), no = little_endian(0.0f);
  std::string file =
      little_endian(std::int32_t{20000630}) + little_endian(std::int32_t{2}) +
      exr_attribute("channels", "chlist", channels + '\0') +
      exr_attribute("compression", "compression", std::string(1, kind.compression)) +
      exr_attribute("dataWindow", "box2i", window) + exr_attribute("displayWindow", "box2i", window) +
      exr_attribute("lineOrder", "lineOrder", std::string(1, '\1')) +
      exr_attribute("pixelAspectRatio", "float", one) + exr_attribute("screenWindowCenter", "v2f", no + no) +
      exr_attribute("screenWindowWidth", "float", one) + '\0';
  const std::int32_t step = kind.compression == 3 ? 16 : 1, blocks = (height + step - 1) / step;
  std::string places(std::size_t(blocks) * 8, '\0'), data;
  for (std::int32_t i = blocks - 1; i >= 0; --i) {
    const std::int32_t rows = std::min(step, height - i * step);
    std::string raw(std::size_t(rows * width * 4 * kind.value_bytes), '\0');
    for (std::size_t k = 0; k < raw.size(); ++k) raw[k] = static_cast<char>((k + std::size_t(i)) * 5 % 61);
    const std::string packed = kind.compression == 0 ? raw : zipped(raw);
    const std::string& kept = packed.size() < raw.size() ? packed : raw;
    places.replace(std::size_t(i) * 8, 8,
                   little_endian(std::uint64_t(file.size() + places.size() + data.size())));
    data += little_endian(std::int32_t{3 + i * step}) + little_endian(std::int32_t(kept.size())) + kept;
  }
  return file + places + data;
}

constexpr ExrKind exr_kinds[]{{0, 2}, {0, 4}, {2, 2}, {2, 4}, {3, 2}, {3, 4}};

TEST(ImageDecode, TheUsualKindsOfExr) {
  const TemporaryFolder folder;
  for (const ExrKind& kind : exr_kinds) {
    SCOPED_TRACE(fmt::format("compression {}, values of {} bytes", int(kind.compression), kind.value_bytes));
    const std::string bytes = exr(kind, 13, 37), path = folder.put("a.exr", bytes);
    const auto own = decode_exr(bytes);
    ASSERT_TRUE(own);
    EXPECT_EQ(exr_size(bytes), own->size);
    expect_channels_as_open_image_io(*own, path);
  }
}

// Whatever its bytes say: a picture or none, and nothing read or written outside (sanitizers look on).
TEST(ImageDecode, ADamagedExrIsLeftToOpenImageIo) {
  std::mt19937 random(3);
  for (const ExrKind& kind : exr_kinds) {
    const std::string whole = exr(kind, 5, 19);
    for (std::size_t keep = 0; keep < whole.size(); ++keep)
      ASSERT_FALSE(decode_exr(std::string_view(whole).substr(0, keep))) << keep;
    for (int i = 0; i < 2000; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 3; ++k) damaged[random() % (i < 1000 ? 400 : damaged.size())] = char(random());
      decode_exr(damaged);
    }
  }
  std::string twice = exr({0, 4}, 5, 19);
  const std::size_t places = twice.size() - std::size_t{19} * (8 + 8 + 5 * 4 * 4);
  twice.replace(places, 8, twice.substr(places + 8, 8));
  EXPECT_FALSE(decode_exr(twice)) << "a row is missing";
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
