// What the program runs on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison.h"
#include "scene/base/expected.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace CLI {
class App;
}
namespace gnomon {
class TextureMemory;
}

namespace gnomon::app {

/// From /proc/cpuinfo, /etc/os-release and, the load at this moment, /proc/loadavg; "unknown" where they do not say.
compare::MachineInfo machine_info();

/// MachineInfo::load: the first number of /proc/loadavg.
std::optional<double> load_of_last_minute();

/// The most memory that the process has held at a time so far.
std::uint64_t peak_memory_bytes();

/// What the machine could still give, bytes; infinite where it does not say.
double available_memory();

/// What an OpenGL context of Mesa takes of the address space besides pictures and maps, bytes. It was measured:
/// with less, Mesa and LLVM run out of memory, and not always with an error.
inline constexpr double graphics_bytes = 480e6;

/// ErrorKind::graphics when a picture of this size, and so many bytes besides, needs more memory than the machine
/// or a limit (ulimit -v) has left. Without this error the process would end without a word.
Expected<void> check_memory(ImageSize size, double bytes_per_pixel, double other_bytes = 0.0);

// How much memory a picture may take, and into how many bands it is cut for that.

struct GivenBytes {
  double bytes = 0.0;
  std::string text;  ///< as it was given
};
/// What --memory says; nothing: default_memory().
using MemoryLimit = std::optional<GivenBytes>;

/// --memory, of pictures and of a scene's textures.
void add_memory(CLI::App& command, MemoryLimit& bytes, MemoryLimit& textures);
/// By default half of what the machine, or the process's control group, has free.
TextureMemory texture_memory(const MemoryLimit& limit);
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

/// These are what the two renderers' pictures take, measured from 320x180 to 2560x1440 with one light. What the rasterizer's
/// camera sees and a PNG on its way to its file are whole.
inline constexpr PictureBytes raster_png{.piece = 42.0, .whole = 18.0, .band = 34.0},
    raster_exr{.piece = 178.0, .whole = 8.0, .band = 170.0},
    raytrace_png{.piece = 109.0, .whole = 10.0, .band = 109.0},
    raytrace_exr{.piece = 216.0, .whole = 0.0, .band = 216.0};
/// Tells what a comparison of those lights takes; `page`: with the images of its report page.
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

/// Runs it where every thread has a stack of 8 MiB at least, the one that runs it and those that libraries start. A smaller limit
/// (ulimit -s) holds for the system's own threads alone, which are then left.
int with_enough_stack(int (*run)(int, char**), int argc, char** argv);

// What becomes of the program when a library cannot start a thread (a limit on processes, ulimit -u). The program tries
// beforehand how many it can have (limit_threads() in session.h, image_library()); what it finds may have changed by the time
// that they are started.

/// To be called first. From here on, a thread may be refused where nothing else can be done. The process then ends
/// with ErrorKind::graphics and one line. Else it would abort, throw out of a library or wait for ever.
void end_in_words_without_threads();

}  // namespace gnomon::app
