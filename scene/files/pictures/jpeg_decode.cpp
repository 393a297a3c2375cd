#include <fmt/core.h>
#include <turbojpeg.h>

#include <memory>

#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/image_library.h"

namespace gnomon {
namespace {

// ISO/IEC 10918-1, annex B: segments with lengths up to the first scan; after it, 0xff 0xd9 is the end and
// nothing else. The library fills what is missing with grey.
Expected<void> check_is_whole(std::string_view bytes, const std::string& name) {
  constexpr unsigned char start_of_scan = 0xda;
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[at + i]); };
    if (byte(0) != 0xff) return bad_image(name, "the JPEG file is damaged before its picture");
    if (byte(1) == start_of_scan) {
      if (bytes.find("\xff\xd9", at) != std::string_view::npos) return {};
      break;
    }
    const bool is_fill = byte(1) == 0xff;
    at += is_fill ? 1u : 2u + (static_cast<std::size_t>(byte(2)) << 8 | byte(3));
  }
  return bad_image(name, "the JPEG file is cut off");
}

struct Destroy {
  void operator()(void* decoder) const { tjDestroy(decoder); }
};

}  // namespace

Expected<std::optional<DecodedImage>> decode_jpeg(const std::string& name, std::string_view bytes,
                                                  const HeaderCheck& check) {
  if (const auto whole = check_is_whole(bytes, name); !whole) return fail(whole.error());
  const std::unique_ptr<void, Destroy> decoder(tjInitDecompress());
  if (!decoder) return fail(ErrorKind::internal, fmt::format("TurboJPEG: {}", tjGetErrorStr2(nullptr)));
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  const auto damaged = [&] {
    return bad_image(name, fmt::format("the JPEG file is damaged: {}", tjGetErrorStr2(decoder.get())));
  };
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &subsampling, &colours) != 0)
    return damaged();
  if (width > max_image_side || height > max_image_side)
    return bad_image(name, fmt::format("image size (got {} x {}, allowed 1 x 1 to {} x {})", width, height,
                                       max_image_side, max_image_side));
  if (colours == TJCS_CMYK || colours == TJCS_YCCK) return std::nullopt;
  const bool grey = colours == TJCS_GRAY;
  DecodedImage image{{width, height}, {}, {}, {}};
  image.channels = grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  if (check)
    if (const auto fits = check(image.size, image.channels.size()); !fits) return fail(fits.error());
  image.bytes.resize(image.size.pixels() * image.channels.size());
  // What is only warned of, such as bytes between the segments, leaves a picture.
  const int done = tjDecompress2(decoder.get(), data, bytes.size(), image.bytes.data(), width, 0, height,
                                 grey ? TJPF_GRAY : TJPF_RGB, TJFLAG_LIMITSCANS);
  if (done != 0 && tjGetErrorCode(decoder.get()) == TJERR_FATAL) return damaged();
  return image;
}

}  // namespace gnomon
