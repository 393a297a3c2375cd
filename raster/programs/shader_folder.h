// The program's own shaders, and a folder whose files take the place of those of the same name
// (--shader-dir).
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "raster/frame.h"
#include "raster/options.h"
#include "scene/light.h"

namespace gnomon::raster {

struct ShaderFile {
  std::string_view name;  ///< as --shader-dir takes it: "technique/hard.glsl"
  std::string_view text;
};
std::vector<ShaderFile> own_shaders();
/// By its ending, in small letters: .glsl, .vert, .frag or .h.
bool is_shader(const std::filesystem::path& path);
/// The file of technique/ that turns the map into visibility.
std::string technique_file(const MapOptions& map, const Light& light);

class ShaderFolder {
 public:
  ShaderFolder() = default;
  /// Reads the folder's .glsl, .vert, .frag and .h files, deeper ones too; "" is no folder. A byte order mark
  /// at the start of one is skipped. Error (bad input): no such file, or one that has no shader's name, nor is included by
  /// one that has; it names the path that would count.
  static Expected<ShaderFolder> read(const std::string& folder);

  const std::string& path() const { return path_; }
  /// "DIR/technique/hard.glsl".
  std::string path_of(std::string_view name) const;
  /// What to compile instead of the program's own; null where that stays.
  const std::string* find(const std::string& name) const;
  /// Every file that differs from the program's own, by name.
  std::vector<ReplacedShader> replaced() const;

  /// Which of them draw the frame.
  void begin_frame() { used_.clear(); }
  void note_use(const std::vector<std::string>& names) { used_.insert(names.begin(), names.end()); }
  std::vector<ReplacedShader> used() const;

 private:
  struct File {
    std::string text, sha256;  ///< without a byte order mark; of the whole file
  };
  std::string path_;
  std::map<std::string, File> files_;  ///< that differ from the program's own, or are new
  std::set<std::string> used_;
};

/// What stands in a pixel that no shader has written.
inline constexpr float unwritten_visibility = std::numeric_limits<float>::lowest();

/// The error (bad input) of a shader that draws the same picture otherwise when it is timed.
Error draws_differently(const ShaderFolder& folder, const std::string& technique_file);

/// Error (bad input) that names the first pixel where a shader of the folder wrote a visibility outside
/// [0, 1], one that is no number, or none.
Expected<void> check_visibility(const Image<float>& visibility, const ShaderFolder& folder,
                                const std::string& technique_file);

// Whether files of a shader folder decide the visibility that is drawn. Private to raster.

/// The files of the folder that take the place of the program's: of the technique's own files, of the irregular
/// z-buffer's, or of those that give the technique its input. The last are shade.frag, gap.glsl (the test of
/// depths), light.glsl and light_map.glsl (the lookup), and what fills the maps of moments. None where all of these
/// files are the program's.
std::optional<CustomShader> custom_shader(const ShaderFolder& folder, const MapOptions& map,
                                          const Light& light);

// Which of the program's own shaders a technique reads.

/// Its files of technique/ under whatever options, light and scene: of pcf one for each kernel.
std::set<std::string> technique_files(Technique technique);

/// Every file that may be compiled when a picture is drawn with it, those of technique_files() too.
std::set<std::string> files_read_by(Technique technique);

}  // namespace gnomon::raster
