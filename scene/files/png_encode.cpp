// PNG files (ISO/IEC 15948) of 8-bit RGB by zlib alone. Rows are filtered and deflated in strips over all
// threads; a strip ends at a byte (RFC 1951, a stored block of length 0), so that the strips' streams may
// follow each other, and begins with the last 32 KiB of the one before as its dictionary.
#include <tbb/parallel_for.h>
#include <zlib.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "scene/files/image_io.h"

namespace gnomon {
namespace {

constexpr int level = 4;                            // of zlib: beyond it files shrink by little
constexpr std::size_t strip_bytes = 512 * 1024;     // before compression
constexpr std::size_t dictionary_bytes = 1u << 15;  // all that deflate looks back
constexpr std::size_t pixel_bytes = 3;

using Row = std::vector<std::uint8_t>;

void put_number(std::string& out, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(v >> shift & 0xff));
}

void put_chunk(std::string& out, const char* type, std::string_view data) {
  put_number(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.append(type, 4).append(data);
  put_number(out, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(out.data() + start),
                                                   static_cast<uInt>(out.size() - start))));
}

std::uint64_t weight(const Row& row) {
  return std::accumulate(row.begin() + 1, row.end(), std::uint64_t{0}, [](std::uint64_t sum, std::uint8_t v) {
    return sum + static_cast<std::uint64_t>(std::abs(static_cast<std::int8_t>(v)));
  });
}

/// Filters 0 to 2 (none, sub, up): of each row the one whose bytes, taken with a sign, sum to the least
/// (section 12.8 of the standard).
class Filter {
 public:
  explicit Filter(const Rgb8Image& image)
      : image_(image), bytes_(pixel_bytes * static_cast<std::size_t>(image.size.width)) {}
  std::size_t row_bytes() const { return bytes_ + 1; }

  void write(int y, std::uint8_t* out) const {
    const std::uint8_t* row = at(y);
    Row plain(row_bytes()), sub(row_bytes()), up(row_bytes());
    plain[0] = 0, sub[0] = 1, up[0] = 2;
    std::memcpy(plain.data() + 1, row, bytes_);
    std::memcpy(sub.data() + 1, row, pixel_bytes);
    for (std::size_t i = pixel_bytes; i < bytes_; ++i)
      sub[i + 1] = static_cast<std::uint8_t>(row[i] - row[i - pixel_bytes]);
    const Row* best = weight(sub) < weight(plain) ? &sub : &plain;
    if (y > 0) {
      const std::uint8_t* above = at(y - 1);
      for (std::size_t i = 0; i < bytes_; ++i) up[i + 1] = static_cast<std::uint8_t>(row[i] - above[i]);
      if (weight(up) < weight(*best)) best = &up;
    }
    std::memcpy(out, best->data(), best->size());
  }

 private:
  const std::uint8_t* at(int y) const {
    return reinterpret_cast<const std::uint8_t*>(&image_.data[image_.index(0, y)]);
  }
  const Rgb8Image& image_;
  std::size_t bytes_;
};

struct Strip {
  std::size_t begin, end;  // of the filtered bytes
  std::string deflated;
  uLong adler = 1;
  bool done = false;
};

void deflate_strip(const Row& raw, bool last, Strip& strip) {
  const auto length = static_cast<uInt>(strip.end - strip.begin);
  const Bytef* bytes = raw.data() + strip.begin;
  strip.adler = adler32(1, bytes, length);
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY) != Z_OK) return;
  const std::size_t known = std::min(strip.begin, dictionary_bytes);
  if (known > 0) deflateSetDictionary(&stream, bytes - known, static_cast<uInt>(known));
  strip.deflated.resize(deflateBound(&stream, length) + 16);
  stream.next_in = const_cast<Bytef*>(bytes), stream.avail_in = length;
  stream.next_out = reinterpret_cast<Bytef*>(strip.deflated.data());
  stream.avail_out = static_cast<uInt>(strip.deflated.size());
  const int result = deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);
  strip.done = result == (last ? Z_STREAM_END : Z_OK) && stream.avail_in == 0 && stream.avail_out > 0;
  strip.deflated.resize(stream.total_out);
  deflateEnd(&stream);
}

std::vector<Strip> strips_of(const Row& raw) {
  std::vector<Strip> strips;
  for (std::size_t at = 0; at < raw.size(); at += strip_bytes)
    strips.push_back({at, std::min(at + strip_bytes, raw.size()), {}});
  tbb::parallel_for(std::size_t{0}, strips.size(),
                    [&](std::size_t i) { deflate_strip(raw, i + 1 == strips.size(), strips[i]); });
  return strips;
}

}  // namespace

Expected<std::string> encode_png(const Rgb8Image& image) {
  if (image.size.width <= 0 || image.size.height <= 0)
    return fail(ErrorKind::internal, "cannot encode an image without pixels");
  const Filter filter(image);
  Row raw(filter.row_bytes() * static_cast<std::size_t>(image.size.height));
  tbb::parallel_for(0, image.size.height, [&](int y) {
    filter.write(y, raw.data() + filter.row_bytes() * static_cast<std::size_t>(y));
  });
  const std::vector<Strip> strips = strips_of(raw);

  std::string header;
  put_number(header, static_cast<std::uint32_t>(image.size.width));
  put_number(header, static_cast<std::uint32_t>(image.size.height));
  header.append({8, 2, 0, 0, 0});  // bits, RGB, deflate, the standard's filters, no interlace
  std::string data = "\x78\x5e";   // a zlib stream of a window of 32 KiB (RFC 1950)
  uLong adler = 1;
  for (const Strip& strip : strips) {
    if (!strip.done) return fail(ErrorKind::internal, "zlib could not deflate the image");
    data += strip.deflated;
    adler = adler32_combine(adler, strip.adler, static_cast<z_off_t>(strip.end - strip.begin));
  }
  put_number(data, static_cast<std::uint32_t>(adler));
  std::string out = "\x89PNG\r\n\x1a\n";
  put_chunk(out, "IHDR", header);
  put_chunk(out, "sRGB", std::string_view("\0", 1));  // perceptual
  put_chunk(out, "IDAT", data);
  put_chunk(out, "IEND", {});
  return out;
}

}  // namespace gnomon
