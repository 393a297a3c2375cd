// PNG files of 8-bit RGB: the container by libpng, the pixels' stream by libdeflate. No filters: rendered
// pictures come out as large as with them. Not through OpenImageIO, whose loading alone takes longer than
// encoding does (image_library.h).
#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>

#include "scene/files/deflate.h"
#include "scene/files/image_io.h"

namespace gnomon {
namespace {

constexpr int level = 3;

/// Each row after the byte that names its filter: 0, none.
std::string rows_of(const Rgb8Image& image) {
  static_assert(sizeof(image.data[0]) == 3);
  const std::size_t row = 3 * static_cast<std::size_t>(image.size.width);
  std::string out((row + 1) * static_cast<std::size_t>(image.size.height), '\0');
  for (int y = 0; y < image.size.height; ++y)
    std::memcpy(&out[static_cast<std::size_t>(y) * (row + 1) + 1], &image.at(0, y), row);
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
bool write_chunks(png_structp png, png_infop info, const ImageSize& size, const std::string& pixels) {
  if (setjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf))) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
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

}  // namespace

Expected<std::string> encode_png(const Rgb8Image& image) {
  if (image.size.width <= 0 || image.size.height <= 0)
    return fail(ErrorKind::internal, "cannot encode an image without pixels");
  const std::string pixels = deflate(rows_of(image), level);
  Container out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &out, fail_writing, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info != nullptr) png_set_write_fn(png, &out, append, nullptr);
  const bool written = info != nullptr && write_chunks(png, info, image.size, pixels);
  png_destroy_write_struct(&png, &info);
  if (!written) return fail(ErrorKind::internal, fmt::format("libpng: {}", out.error));
  return std::move(out.bytes);
}

}  // namespace gnomon
