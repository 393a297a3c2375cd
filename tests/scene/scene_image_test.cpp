// Images in and out: round trips, hostile headers, values that are not numbers.
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "scene/files/pictures/image_io.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

std::string png_header(std::uint32_t width, std::uint32_t height) {
  return "\x89PNG\r\n\x1a\n" + test::png_chunk("IHDR", test::big_endian(width) + test::big_endian(height) +
                                                           std::string("\x08\x02\0\0\0", 5));
}

Rgb8Image gradient(int width, int height) {
  Rgb8Image image({width, height});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 200};
  return image;
}

TEST(Image, PngRoundTripIsExactAndUpright) {
  const TemporaryFolder folder;
  const Rgb8Image image = gradient(17, 9);
  ASSERT_TRUE(write_png(folder.file("a.png"), image));
  const auto read = read_texture(folder.file("a.png"), true);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size, image.size);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    EXPECT_EQ(read->texels[i], glm::u8vec4(image.data[i], 255));
  EXPECT_EQ(folder.file_count(), 1u);
}

// Flat, noisy and smooth rows, which deflate in different ways.
TEST(Image, PngOfLargePicturesIsExact) {
  Rgb8Image image({1021, 611});
  std::uint32_t noise = 1;
  for (int y = 0; y < image.size.height; ++y)
    for (int x = 0; x < image.size.width; ++x) {
      noise = noise * 1664525u + 1013904223u;
      const auto random = static_cast<std::uint8_t>(noise >> 24),
                 smooth = static_cast<std::uint8_t>(x / 5 + y);
      const auto value = y < 100 ? std::uint8_t{7} : y < 300 ? random : smooth;
      image.at(x, y) = {value, smooth, y % 7 == 0 ? random : value};
    }
  const auto bytes = encode_png(image);
  ASSERT_TRUE(bytes);
  const auto read = read_texture_bytes("large", *bytes, true);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size, image.size);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    wrong += read->texels[i] == glm::u8vec4(image.data[i], 255) ? 0 : 1;
  EXPECT_EQ(wrong, 0u);
}

TEST(Image, EncodedPngIsTheSameFile) {
  const TemporaryFolder folder;
  const auto bytes = encode_png(gradient(33, 5));
  ASSERT_TRUE(bytes);
  ASSERT_TRUE(write_png(folder.file("a.png"), gradient(33, 5)));
  EXPECT_EQ(test::bytes_of(folder.file("a.png")), *bytes);
  EXPECT_EQ(*encode_png(gradient(33, 5)), *bytes);  // nothing of the clock in it
}

TEST(Image, TruncatedPngIsAnErrorWhereverItEnds) {
  const auto bytes = encode_png(gradient(64, 64));
  ASSERT_TRUE(bytes);
  const TemporaryFolder folder;
  for (const std::size_t keep : {std::size_t{8}, std::size_t{20}, std::size_t{40}, bytes->size() / 2}) {
    const std::string path = folder.put("cut.png", bytes->substr(0, keep));
    const auto read = read_texture(path, true);
    ASSERT_FALSE(read) << keep;
    EXPECT_EQ(read.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(read.error().file, path);
    EXPECT_EQ(read.error().message().find('\n'), std::string::npos) << read.error().message();
  }
}

// A JPEG of no picture at all, but with the segments of one: only where it ends matters here.
TEST(Image, TruncatedJpegIsAnError) {
  const std::string thumbnail =
      std::string("\xff\xe1\x00\x06", 4) + "\xff\xd8\xff\xd9";  // its end is not the file's
  const std::string cut = "\xff\xd8" + thumbnail + std::string("\xff\xda\x00\x02", 4) + "data";
  EXPECT_EQ(read_texture_bytes("a.jpg", cut, true).error().message(), "a.jpg: the JPEG file is cut off");
  EXPECT_EQ(read_texture_bytes("a.jpg", cut.substr(0, 8), true).error().message(),
            "a.jpg: the JPEG file is cut off");
  EXPECT_NE(read_texture_bytes("a.jpg", cut + "\xff\xd9", true).error().message(),
            "a.jpg: the JPEG file is cut off");
}

TEST(Image, HugeHeaderIsRefusedBeforeAllocation) {
  for (const std::uint32_t side : {16385u, 100000u, 0x7fffffffu}) {
    const auto read = read_texture_bytes(
        "huge.png", png_header(side, side) + test::png_chunk("IDAT", "") + test::png_chunk("IEND", ""), true);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, ErrorKind::bad_input);
  }
  const auto named = read_texture_bytes(
      "huge.png", png_header(100000, 100000) + test::png_chunk("IDAT", "") + test::png_chunk("IEND", ""),
      true);
  EXPECT_EQ(named.error().message(),
            "huge.png: image size (got 100000 x 100000, allowed 1 x 1 to 16384 x 16384)");
}

TEST(Image, NotAnImageIsAnError) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_texture(folder.put("a.png", ""), true));
  EXPECT_FALSE(read_texture(folder.put("b.png", "hello"), true));
  EXPECT_FALSE(read_texture(folder.file("missing.png"), true));
  EXPECT_FALSE(read_texture(folder.path(), true));
  EXPECT_FALSE(read_texture_bytes("x", std::string(100, '\0'), true));
}

TEST(Image, ExrKeepsNamesValuesAndAttributes) {
  const TemporaryFolder folder;
  const ImageSize size{5, 37};  // three of the file's blocks
  std::vector<Channel> channels;
  for (const std::string name :
       {"a.name.of.more.than.31.characters", "position.X", "position.Y", "position.Z", "normal.X", "truth.V",
        "drawn.V", "class.V", "texel_uv.U", "texel_uv.V", "gap.V", "R", "G", "B"}) {
    Channel channel{name, std::vector<float>(size.pixels())};
    for (std::size_t i = 0; i < channel.values.size(); ++i)
      channel.values[i] = static_cast<float>(channels.size() * 100 + i) + 0.1f;  // not a half's value
    channels.push_back(std::move(channel));
  }
  channels[4].values[2] = std::nanf("");
  channels[9].values[1] = -INFINITY;
  const std::pair<std::string, std::string> scene{"gnomon:scene", "fence"};
  ASSERT_TRUE(write_exr(folder.file("a.exr"), size, channels, {&scene, 1}));
  const auto read = read_channels(folder.file("a.exr"));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->size, size);
  ASSERT_EQ(read->channels.size(), channels.size());
  for (const Channel& channel : channels) {
    const Channel* found = read->find(channel.name);
    ASSERT_NE(found, nullptr) << channel.name;
    for (std::size_t i = 0; i < channel.values.size(); ++i)
      EXPECT_TRUE(found->values[i] == channel.values[i] ||
                  (std::isnan(channel.values[i]) && std::isnan(found->values[i])))
          << channel.name << " " << i;
  }
  EXPECT_NE(test::bytes_of(folder.file("a.exr")).find("fence"), std::string::npos);
}

// No compression makes less of noise: its blocks are stored as they are.
TEST(Image, ExrKeepsNoise) {
  const TemporaryFolder folder;
  const ImageSize size{31, 40};
  std::mt19937 bits(1);
  Channel noise{"Y", std::vector<float>(size.pixels())};
  for (float& value : noise.values)
    value = std::bit_cast<float>(static_cast<std::uint32_t>(bits()) & 0xbf7fffffu);  // finite ones
  ASSERT_TRUE(write_exr(folder.file("a.exr"), size, {&noise, 1}));
  EXPECT_GT(test::bytes_of(folder.file("a.exr")).size(), 4 * size.pixels());
  const auto read = read_channels(folder.file("a.exr"));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->channels.at(0).values, noise.values);
}

TEST(Image, WritesToAFullDiskAreErrors) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  EXPECT_EQ(write_png("/dev/full", gradient(4, 4)).error().kind, ErrorKind::cannot_write);
  const Channel channel{"R", {1.0f}};
  EXPECT_EQ(write_exr("/dev/full", {1, 1}, {&channel, 1}).error().kind, ErrorKind::cannot_write);
}

TEST(Image, FloatTexturesAreEncodedOrRefused) {
  const TemporaryFolder folder;
  std::vector<Channel> rgb{{"R", {0.5f, 2.0f}}, {"G", {0.0f, -1.0f}}, {"B", {1.0f, 0.25f}}};
  ASSERT_TRUE(write_exr(folder.file("a.exr"), {2, 1}, rgb));
  const auto encoded = read_texture(folder.file("a.exr"), true);
  ASSERT_TRUE(encoded) << encoded.error().message();
  EXPECT_EQ(encoded->texels[0], glm::u8vec4(188, 0, 255, 255));
  EXPECT_EQ(encoded->texels[1], glm::u8vec4(255, 0, 137, 255));
  rgb[1].values[0] = std::nanf("");
  ASSERT_TRUE(write_exr(folder.file("nan.exr"), {2, 1}, rgb));
  const auto refused = read_texture(folder.file("nan.exr"), true);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("1 values are not finite"), std::string::npos)
      << refused.error().message();
}

TEST(Image, SrgbFunctionsInvertEachOther) {
  for (int i = 0; i < 256; ++i) {
    const float encoded = static_cast<float>(i) / 255.0f;
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(encoded)), encoded,
                1e-6f);  // two float pows of values up to 1
  }
}

// display_image finds the code by search; the formula with rounding is the reference.
TEST(Image, DisplayRoundsToTheNearestCode) {
  ColorImage image({1000, 1});
  for (int x = 0; x < 1000; ++x) image.at(x, 0) = Vec3f(static_cast<float>(x) / 999.0f);
  const Rgb8Image shown = display_image(image, 1.0);
  for (int x = 0; x < 1000; ++x) {
    const double linear = static_cast<double>(image.at(x, 0).r);
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
    EXPECT_EQ(static_cast<long>(shown.at(x, 0).r), std::lround(255.0 * encoded)) << x;
  }
}

// A code begins where its decoding lies half a code below it: there, and one float before it.
TEST(Image, DisplayChangesWhereEachCodeBegins) {
  ColorImage image({255, 1});
  for (int code = 1; code <= 255; ++code) {
    const double encoded = (code - 0.5) / 255.0;
    const double begin = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    const auto near = static_cast<float>(begin);
    const float above = static_cast<double>(near) >= begin ? near : std::nextafter(near, 2.0f);
    image.at(code - 1, 0) = {std::nextafter(above, 0.0f), above, std::nextafter(above, 2.0f)};
  }
  const Rgb8Image shown = display_image(image, 1.0);
  for (int code = 1; code <= 255; ++code)
    EXPECT_EQ(shown.at(code - 1, 0), glm::u8vec3(code - 1, code, code)) << code;
}

TEST(Image, DisplayClipsAndFlagsNan) {
  ColorImage image({3, 1});
  image.at(0, 0) = {-1.0f, 0.5f, 1e30f};
  image.at(1, 0) = {std::nanf(""), 0.0f, 0.0f};
  image.at(2, 0) = {INFINITY, -INFINITY, 0.25f};
  const Rgb8Image shown = display_image(image, 2.0);
  EXPECT_EQ(shown.at(0, 0), glm::u8vec3(0, 255, 255));
  EXPECT_EQ(shown.at(1, 0), glm::u8vec3(255, 0, 255));
  EXPECT_EQ(shown.at(2, 0), glm::u8vec3(255, 0, 188));
}

// A film's list names further files and addresses, which what reads films would open.
TEST(Image, AFilmIsNoPicture) {
  const TemporaryFolder folder;
  const std::string list = "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nother.ts\n#EXT-X-ENDLIST\n";
  for (const char* name : {"a.mp4", "a.avi", "a.mov"}) {
    const std::string path = folder.put(name, list);
    const auto channels = read_channels(path);
    ASSERT_FALSE(channels) << name;
    EXPECT_NE(channels.error().reason.find("a film is no picture"), std::string::npos)
        << channels.error().message();
    const auto size = read_image_size(path);
    ASSERT_FALSE(size) << name;
    EXPECT_NE(size.error().reason.find("a film is no picture"), std::string::npos) << size.error().message();
  }
}

}  // namespace
}  // namespace gnomon
