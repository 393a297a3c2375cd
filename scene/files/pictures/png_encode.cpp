// PNG files of 8 bits: the container by libpng, the pixels' stream by libdeflate. Pictures of at most 256
// colours get a palette, the rest is RGB or, where texels are not opaque, RGBA. No filters: rendered pictures come out as large as with them. Not
// through OpenImageIO, whose loading alone takes longer than encoding does (image_library.h).
#include <fmt/core.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <unordered_map>
#include <vector>

#include "scene/files/encodings.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon {
namespace {

constexpr int colour_level = 2, palette_level = 4;

/// Each row after the byte that names its filter: 0, none. `bytes`: of a pixel.
std::string rows_of(const char* pixels, const ImageSize& size, std::size_t bytes) {
  const std::size_t row = bytes * static_cast<std::size_t>(size.width);
  std::string out((row + 1) * static_cast<std::size_t>(size.height), '\0');
  for (std::size_t y = 0; y < static_cast<std::size_t>(size.height); ++y)
    std::memcpy(&out[y * (row + 1) + 1], pixels + y * row, row);
  return out;
}

/// A picture of few colours: these, and for each pixel its colour's place among them.
struct Paletted {
  std::vector<png_color> colours;
  std::string places;
};

/// Nothing where a byte is too small for the places.
std::optional<Paletted> paletted(const Rgb8Image& image) {
  Paletted out;
  out.places.reserve(image.data.size());
  std::unordered_map<std::uint32_t, char> known;
  glm::u8vec3 last{};
  char place = 0;
  for (const glm::u8vec3& c : image.data) {
    if (known.empty() || c != last) {
      const std::uint32_t key = std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | c.b;
      const auto [entry, is_new] = known.try_emplace(key, static_cast<char>(out.colours.size()));
      if (known.size() > 256) return {};
      if (is_new) out.colours.push_back({c.r, c.g, c.b});
      place = entry->second;
      last = c;
    }
    out.places += place;
  }
  return out;
}

/// What libpng writes, or why it could not.
struct Container {
  std::string bytes, error;
};

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<Container*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
}
[[noreturn]] void fail_writing(png_structp png, png_const_charp message) {
  static_cast<Container*>(png_get_error_ptr(png))->error = message;
  std::longjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf)), 1);
}

/// libpng's errors jump back to here, over nothing that would have to be destroyed.
bool write_chunks(png_structp png, png_infop info, const ImageSize& size, int color_type,
                  const std::vector<png_color>& colours, const std::string& pixels) {
  if (setjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf))) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height), 8,
               color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  if (!colours.empty()) png_set_PLTE(png, info, colours.data(), static_cast<int>(colours.size()));
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  const auto chunk = [&](const char* name, const std::string& data) {
    png_write_chunk(png, reinterpret_cast<png_const_bytep>(name),
                    reinterpret_cast<png_const_bytep>(data.data()), data.size());
  };
  chunk("IDAT", pixels);
  chunk("IEND", {});
  return true;
}

/// `pixels`: compressed.
Expected<std::string> contain(const ImageSize& size, int color_type, const std::vector<png_color>& colours,
                              const std::string& pixels) {
  Container out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &out, fail_writing, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info != nullptr) png_set_write_fn(png, &out, append, nullptr);
  const bool written = info != nullptr && write_chunks(png, info, size, color_type, colours, pixels);
  png_destroy_write_struct(&png, &info);
  if (!written) return fail(ErrorKind::internal, fmt::format("libpng: {}", out.error));
  return std::move(out.bytes);
}

}  // namespace

Expected<std::string> encode_png(const Rgb8Image& image) {
  if (image.size.width <= 0 || image.size.height <= 0)
    return fail(ErrorKind::internal, "cannot encode an image without pixels");
  static_assert(sizeof(image.data[0]) == 3);
  if (const std::optional<Paletted> few = paletted(image))
    return contain(image.size, PNG_COLOR_TYPE_PALETTE, few->colours,
                   deflate(rows_of(few->places.data(), image.size, 1), palette_level));
  return contain(
      image.size, PNG_COLOR_TYPE_RGB, {},
      deflate(rows_of(reinterpret_cast<const char*>(image.data.data()), image.size, 3), colour_level));
}

Expected<std::string> encode_png(const Texture& texture) {
  static_assert(sizeof(texture.texels[0]) == 4);
  if (std::any_of(texture.texels.begin(), texture.texels.end(),
                  [](const glm::u8vec4& t) { return t.a != 255; }))
    return contain(texture.size, PNG_COLOR_TYPE_RGB_ALPHA, {},
                   deflate(rows_of(reinterpret_cast<const char*>(texture.texels.data()), texture.size, 4),
                           palette_level));
  Rgb8Image image(texture.size);
  std::transform(texture.texels.begin(), texture.texels.end(), image.data.begin(),
                 [](const glm::u8vec4& t) { return glm::u8vec3(t); });
  return encode_png(image);
}

}  // namespace gnomon
