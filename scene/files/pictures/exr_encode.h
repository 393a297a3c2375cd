// OpenEXR files of 32-bit float channels as bytes. They are encoded here, for OpenImageIO takes longer to load than most
// pictures take to encode (image_library.h), and a page has none.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/files/pictures/image_io.h"
#include "scene/image.h"

namespace gnomon {

/// One part in scan lines from the top, compressed by ZIP in blocks of 16 rows (openexr.com, "OpenEXR File Layout"). A file
/// is begin(), as it is after the last rows, and what add() returned, in order.
class ExrEncoder {
 public:
  /// The names of the channels, and metadata as text.
  ExrEncoder(ImageSize size, std::span<const Channel> channels,
             std::span<const std::pair<std::string, std::string>> attributes);
  /// The header and the places of all blocks, of which those to come are 0: as long at first as at last.
  std::string begin() const;
  /// The next so many rows: a multiple of 16, or the last ones. Each channel has a value for each pixel of them, and is
  /// where it was in the constructor.
  std::string add(int rows, std::span<const Channel> channels);

 private:
  int width_;
  std::vector<std::size_t> order_;  ///< of the channels in the file
  std::string header_;
  std::vector<std::uint64_t> places_;  ///< of the blocks, bytes
  std::size_t blocks_ = 0;             ///< that have their place
  int row_ = 0;                        ///< the next one
  std::uint64_t bytes_ = 0;            ///< of the file so far
};

}  // namespace gnomon
