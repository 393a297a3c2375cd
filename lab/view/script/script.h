// The viewer's scripts: one step a line, `#` starts a comment, words are separated by blanks.
//
//   set KEY VALUE...      a key below, or any option of the shadow map as on the command line (set bias
//                         0.5texel)
//   open SCENE            a file, a built-in scene or a lesson
//   show PRESET           acne, peter-panning, aliasing or leak
//   drag X Y X Y [left|right|middle], click X Y, point X Y      the pointer, in pixels of the window
//   drag light X Y        the light's handle, to there
//   drop FILE             a file let fall on the window
//   key NAME              a key of docs/lab.md: F6, tab, ctrl+B; enter, too, for menus and panels
//   wait N | wait done    N frames, or until the comparison of what is set is finished and shown, and a search, a
//                         report or a file that was begun is done
//   screenshot FILE.png   what the window shows, once all that is set before has been drawn
//   save-scene FILE.json  the scene as it is set
//   print                 the compare command, on stdout; print clipboard: what was copied last
//   quit                  ends the program; so does the end of the script
//
// Keys:
// - view NAME, size WxH (of the window), layout NAME, pane N VIEW, swipe SHARE, zoom FACTOR, probe X Y
// - light NAME, light-azimuth DEG, light-elevation DEG, light-distance D, light-size S, time-of-day HOURS
// - film NAME|off, film-time S, film-play on|off
// - camera-orbit AZIMUTH ELEVATION, camera-distance D, camera-height H, camera-target X Y Z
// - precision NAME, theme NAME, ui-scale FACTOR, and on or off for panels, settings, results, help and large-type
// A script is read and checked as a whole before the window opens.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lab/view/state/input.h"
#include "lab/view/state/state.h"
#include "scene/base/expected.h"

namespace gnomon::lab {

struct WaitFrames {
  std::int64_t frames;
};
struct WaitDone {};
struct Screenshot {
  std::string path;
};
struct Quit {};
struct PrintCommand {};
/// What the clipboard holds, on stdout.
struct PrintClipboard {};
/// A file let fall on the window.
struct DropFile {
  std::string path;
};
/// A film or a light by its name; which ones the window has is known when the scene is open.
struct PickByName {
  enum class Kind : std::uint8_t { film, light };
  Kind kind;
  std::string name;  ///< "off": no film
};
struct PressKey {
  Key key;  ///< one that does something
};
struct SaveScene {
  std::string path;
};
struct DragPointer {
  Vec2 from{0.0}, to{0.0};  ///< pixels of the window
  int button = 0;           ///< GLFW's
  bool light = false;       ///< from where the light's handle is
};

/// The pointer rests there: what it is on explains itself.
struct PointAt {
  Vec2 at{0.0};  ///< pixels of the window
};

struct ScriptStep {
  int line = 0;  ///< from 1
  std::variant<Change, WaitFrames, WaitDone, Screenshot, Quit, PrintCommand, SaveScene, DragPointer, PointAt,
               PressKey, OpenScene, UsePreset, PrintClipboard, DropFile, PickByName>
      what;
};

/// The first words of steps.
std::span<const std::string_view> script_verbs();

/// Errors are ErrorKind::bad_input with file, line and field. Light names must be among the scene's. `opened`: where
/// given, takes the files of all scenes that the script opens.
Expected<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file,
                                               const std::vector<Light>& lights,
                                               std::vector<std::string>* opened = nullptr);

/// The light's place among these. Error (bad_input): there is none of that name.
Expected<std::uint32_t> light_of_name(const std::string& name, const std::vector<Light>& lights);

// What a script's `set` knows beside the options of the shadow map: each key with its values as a change.

struct ScriptKey {
  std::string_view name;
  std::size_t values;
  std::string_view usage;
  /// Reads as many values as are wanted. Error (usage): they are no such values.
  Expected<Change> (*read)(const std::vector<std::string>& values);
};

/// Null when there is none.
const ScriptKey* find_script_key(std::string_view name);
/// All of them, and "light", which needs the scene.
std::vector<std::string> script_key_names();

}  // namespace gnomon::lab
