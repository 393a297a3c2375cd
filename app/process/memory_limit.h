// How much memory a picture may take, and into how many bands it is cut for that.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/base/expected.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace CLI {
class App;
}

namespace gnomon::app {

struct GivenBytes {
  double bytes = 0.0;
  std::string text;  ///< as it was given
};
/// What --memory says; nothing: default_memory().
using MemoryLimit = std::optional<GivenBytes>;

/// --memory.
void add_memory(CLI::App& command, MemoryLimit& bytes);
/// "2G", "512M", "1.5G", "1000000": bytes, units of 1024. ErrorKind::usage.
Expected<double> parse_bytes(const std::string& text);

/// Half of what the machine, or the process's control group, has free, and no more than 2 GiB: bands cost next to
/// nothing, and larger ones save no more.
double default_memory();

/// What a picture's pixels take, bytes a pixel.
struct PictureBytes {
  double piece = 0.0;  ///< of a picture in one piece
  double whole = 0.0;  ///< in bands: of the whole picture all the while
  double band = 0.0;   ///< in bands: of the one that is worked on
  int margin = 0;      ///< rows that a band is worked on with beside its own
  double soft = 0.0;   ///< in bands: of the rows on which the widths of soft shadows hang

  /// In bands of so many rows.
  double of(const ImageSize& size, int rows) const;
};

/// Of the two renderers' pictures, measured from 320x180 to 2560x1440 with one light. What the rasterizer's camera
/// sees and a PNG on its way to its file are whole.
inline constexpr PictureBytes raster_png{.piece = 42.0, .whole = 18.0, .band = 34.0},
    raster_exr{.piece = 178.0, .whole = 8.0, .band = 170.0},
    raytrace_png{.piece = 109.0, .whole = 10.0, .band = 109.0},
    raytrace_exr{.piece = 216.0, .whole = 0.0, .band = 216.0};
/// Of a comparison of those lights; `page`: with the images of its report page.
PictureBytes compare_bytes(const Scene& scene, const std::vector<std::uint32_t>& lights,
                           const ImageSize& size, bool page);

/// The picture's bands, as large as the limit allows; one where it allows the whole. `most_pixels`: of a band, 0: any
/// number. ErrorKind::graphics where it does not allow even the smallest, with what they need, as
/// --memory takes it.
Expected<std::vector<PictureRows>> plan_bands(const MemoryLimit& limit, const ImageSize& size,
                                              const PictureBytes& bytes, std::size_t most_pixels = 0);

/// "1.2 GB in 17 bands of 512 rows".
std::string bands_text(const ImageSize& size, const PictureBytes& bytes,
                       const std::vector<PictureRows>& bands);

/// Error (graphics) where the smallest bands of the picture and `other` bytes are more than is left (machine.h).
Expected<void> check_memory(const MemoryLimit& limit, const ImageSize& size, const PictureBytes& bytes,
                            double other = 0.0);

}  // namespace gnomon::app
