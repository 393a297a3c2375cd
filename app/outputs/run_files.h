// What one call of the program reads and writes. Nothing may be lost: no output is also an input, no two
// outputs are one file, and every output can be written. Inputs known from the start are checked before
// anything is read, those that only the scene file names before anything is written.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/process/machine.h"
#include "scene/base/expected.h"
#include "scene/world.h"

namespace gnomon::app {

/// What a command does with the map's settings that a lesson or a scene asks for.
enum class SettingsUse : std::uint8_t {
  none,      ///< it draws no map
  taken,     ///< where no option says otherwise
  left_out,  ///< another technique was given, to which they need not belong
  sought     ///< it finds the map's options itself
};

/// A scene as it is given on the command line.
/// A moment of what a scene moves by itself: of an animation of a glTF file, or of a scene's path.
struct SceneTime {
  std::string path;      ///< its name; empty: the first
  double seconds = 0.0;  ///< from its beginning, 0 or more
};

struct SceneArgument {
  std::string name;            ///< a file, a built-in scene or a lesson
  bool allow_outside = false;  ///< files that it names may lie outside its folder
  InstanceChoice instances = InstanceChoice::automatic;
  SettingsUse settings = SettingsUse::none;
  std::optional<SceneTime> time{};  ///< none: all stands as it is stored
  MemoryLimit memory{};             ///< what its textures may take

  /// For a command line that loads the same.
  std::string words() const;
  /// Each by itself, and not quoted.
  std::vector<std::string> plain_words() const;
  /// Another scene, loaded in the same way.
  SceneArgument named(const std::string& other) const;
};

class RunFiles {
 public:
  void reads(const std::string& path);
  void reads(const SceneArgument& scene);
  /// Every shader in the folder and below; "" is no folder.
  void reads_shaders(const std::string& folder);
  /// `option` is named in messages. An empty path and "-" (stdout) are nothing.
  void writes(std::string option, const std::string& path);
  /// A folder, and the files that are always written in it.
  void writes_folder(const std::string& option, const std::string& folder,
                     std::span<const std::string_view> names);

  /// ErrorKind::usage when two of them collide, ErrorKind::cannot_write when an output cannot be written.
  Expected<void> check() const;
  /// What a scene file named.
  Expected<void> also_reads(const std::vector<std::string>& paths);
  const std::vector<std::string>& inputs() const { return inputs_; }

 private:
  struct Output {
    std::string option, path;
    std::string folder{};  ///< it is one of this folder's; else empty
  };
  Expected<void> check_collisions() const;
  std::vector<std::string> inputs_;
  std::vector<Output> outputs_;
  std::vector<std::string> folders_;
};

// Checks that outputs can be written, made before the work whose results they are to hold. Nothing is left
// behind.

/// The folder, or the nearest one above it that exists, takes files; the path itself is not something else.
Expected<void> check_output_folder(const std::string& path);

/// Checks that a file can be written. An empty path and "-" (stdout) are always fine.
Expected<void> check_output_file(const std::string& path);

/// ErrorKind::usage when the path has none of the extensions (".png .exr"); `option` is named in the message.
Expected<void> check_extension(std::string_view option, const std::string& path, std::string_view extensions);

}  // namespace gnomon::app
