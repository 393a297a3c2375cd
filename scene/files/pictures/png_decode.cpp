#include <fmt/core.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <utility>
#include <vector>

#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/image_library.h"

namespace gnomon {
namespace {

constexpr std::size_t most_per_byte =
    1032;  // what deflate makes of one (Gailly and Adler, zlib technical details)

constexpr const char* cut_off = "cut off";

struct Source {
  std::string_view left;
  std::string fault;
};

void read_bytes(png_structp png, png_bytep data, png_size_t size) {
  auto& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (size > source.left.size()) png_error(png, cut_off);
  std::memcpy(data, source.left.data(), size);
  source.left.remove_prefix(size);
}

[[noreturn]] void fail_reading(png_structp png, png_const_charp message) {
  static_cast<Source*>(png_get_error_ptr(png))->fault = message;
  std::longjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf)), 1);
}

// libpng would print them; they are about what does not decide a pixel.
void ignore_warning(png_structp, png_const_charp) {}

struct Header {
  png_uint_32 width = 0, height = 0;
  std::size_t stored_row = 0;  // bytes
};
/// Describes the rows as they are read.
struct Layout {
  std::size_t row = 0, channels = 0;  // bytes
  int depth = 8;                      // bits of a value
};

/// Up to the first pixels. libpng's errors jump back to here, over nothing that would have to be destroyed.
bool read_header(png_structp png, png_infop info, Header& header) {
  if (setjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf))) != 0) return false;
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_read_info(png, info);
  header.width = png_get_image_width(png, info), header.height = png_get_image_height(png, info);
  header.stored_row = png_get_rowbytes(png, info);
  return true;
}

/// To 8 bits, or to 16 where the file has as many and these are wanted, in the machine's order.
bool expand_rows(png_structp png, png_infop info, bool wants_16_bits, Layout& layout) {
  if (setjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf))) != 0) return false;
  png_set_expand(png);
  if (wants_16_bits)
    png_set_swap(png);
  else
    png_set_scale_16(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  layout.row = png_get_rowbytes(png, info), layout.channels = png_get_channels(png, info);
  layout.depth = png_get_bit_depth(png, info);
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf))) != 0) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

Expected<void> check_extent(const std::string& name, const Header& header, std::size_t file_bytes) {
  if (header.width > max_image_side || header.height > max_image_side)
    return bad_image(name, fmt::format("image size (got {} x {}, allowed 1 x 1 to {} x {})", header.width,
                                       header.height, max_image_side, max_image_side));
  if (header.stored_row * header.height / most_per_byte > file_bytes)
    return bad_image(name, fmt::format("the PNG file is cut off: {} bytes cannot hold {} x {} pixels",
                                       file_bytes, header.width, header.height));
  return {};
}

/// The library's state of one file.
class PngReader {
 public:
  explicit PngReader(std::string_view bytes) : source_{bytes, "out of memory"} {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, fail_reading, ignore_warning);
    info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
    if (info_ != nullptr) png_set_read_fn(png_, &source_, read_bytes);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool header(Header& out) { return info_ != nullptr && read_header(png_, info_, out); }
  bool layout(bool wants_16_bits, Layout& out) { return expand_rows(png_, info_, wants_16_bits, out); }
  bool rows(png_bytepp out) { return read_rows(png_, out); }
  std::string fault() const {
    return source_.fault == cut_off ? "the PNG file is cut off"
                                    : fmt::format("the PNG file is damaged: {}", source_.fault);
  }

 private:
  Source source_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

std::vector<std::string> channel_names(std::size_t count) {
  std::vector<std::string> names =
      count < 3 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  if (count % 2 == 0) names.emplace_back("A");
  return names;
}

/// Fractions of the largest value.
void to_floats(DecodedImage& image, int depth) {
  const std::vector<std::uint8_t> bytes = std::exchange(image.bytes, {});
  const std::size_t value_bytes = depth == 16 ? 2 : 1;
  const float step = 1.0f / (depth == 16 ? 65535.0f : 255.0f);
  image.floats.resize(bytes.size() / value_bytes);
  for (std::size_t i = 0; i < image.floats.size(); ++i) {
    std::uint16_t value = bytes[i];
    if (depth == 16) std::memcpy(&value, bytes.data() + 2 * i, sizeof value);
    image.floats[i] = static_cast<float>(value) * step;
  }
}

}  // namespace

Expected<ImageSize> png_size(const std::string& name, std::string_view bytes) {
  PngReader reader(bytes);
  Header header;
  if (!reader.header(header)) return bad_image(name, reader.fault());
  if (const auto fits = check_extent(name, header, bytes.size()); !fits) return fail(fits.error());
  return ImageSize{static_cast<int>(header.width), static_cast<int>(header.height)};
}

Expected<DecodedImage> decode_png(const std::string& name, std::string_view bytes, DecodeAs as,
                                  const HeaderCheck& check) {
  PngReader reader(bytes);
  Header header;
  if (!reader.header(header)) return bad_image(name, reader.fault());
  if (const auto fits = check_extent(name, header, bytes.size()); !fits) return fail(fits.error());
  Layout layout;
  if (!reader.layout(as == DecodeAs::floats, layout)) return bad_image(name, reader.fault());
  const ImageSize size{static_cast<int>(header.width), static_cast<int>(header.height)};
  if (check)
    if (const auto fits = check(size, layout.channels); !fits) return fail(fits.error());
  DecodedImage image{
      size, channel_names(layout.channels), std::vector<std::uint8_t>(layout.row * header.height), {}};
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < header.height; ++y) rows.push_back(image.bytes.data() + y * layout.row);
  if (!reader.rows(rows.data())) return bad_image(name, reader.fault());
  if (as == DecodeAs::floats) to_floats(image, layout.depth);
  return image;
}

}  // namespace gnomon
