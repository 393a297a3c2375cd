// The image library of a page, where textures are PNG or JPEG: all other files are refused.
#include "scene/files/pictures/image_library.h"

namespace gnomon {
namespace {

tl::unexpected<Error> not_read(const std::string& path) {
  Error error{ErrorKind::bad_input, "images are PNG or JPEG here; all others are read on Linux alone"};
  error.file = path;
  return fail(std::move(error));
}

class NoImages final : public ImageLibrary {
 public:
  Expected<ImageSize> size(const std::string& path, int) const override { return not_read(path); }
  Expected<DecodedImage> read(const std::string& path, int, DecodeAs) const override {
    return not_read(path);
  }
  Expected<DecodedImage> decode(const std::string& name, std::string_view, std::string_view,
                                int) const override {
    return not_read(name);
  }
};

}  // namespace

Expected<const ImageLibrary*> image_library() {
  static const NoImages images;
  return &images;
}

}  // namespace gnomon
