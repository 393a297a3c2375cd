// The image library of a page, where textures are PNG or JPEG and other pictures PNG or EXR: all other files are refused.
#include "scene/files/pictures/image_library.h"

namespace gnomon {
namespace {

tl::unexpected<Error> not_read(const std::string& path) {
  Error error{ErrorKind::bad_input,
              "not read here: textures are PNG or JPEG, other pictures PNG or EXR (scan lines, uncompressed "
              "or ZIP), and whole; "
              "Gnomon on Linux reads more"};
  error.file = path;
  return fail(std::move(error));
}

class NoImages final : public ImageLibrary {
 public:
  Expected<ImageSize> size(const std::string& path, int) const override { return not_read(path); }
  Expected<DecodedImage> read(const std::string& path, int, DecodeAs, const HeaderCheck&) const override {
    return not_read(path);
  }
  Expected<DecodedImage> decode(const std::string& name, std::string_view, std::string_view, int,
                                const HeaderCheck&) const override {
    return not_read(name);
  }
};

}  // namespace

Expected<const ImageLibrary*> image_library() {
  static const NoImages images;
  return &images;
}

}  // namespace gnomon
