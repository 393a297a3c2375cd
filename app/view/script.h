// The viewer's scripts: one step a line, `#` starts a comment, words are separated by blanks.
//
//   set KEY VALUE...      a key below, or any option of the shadow map as on the command line (set bias
//   0.5texel) wait N | wait done    N frames, or until the comparison of what is set is finished and shown
//   screenshot FILE.png   what the window shows, once all that is set before has been drawn
//   quit                  ends the program; so does the end of the script
//
// Keys: view NAME, size WxH, light NAME, light-azimuth DEG, light-elevation DEG, camera-orbit AZIMUTH
// ELEVATION, camera-distance D. A script is read and checked as a whole before the window opens.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/view/state.h"
#include "scene/expected.h"

namespace gnomon::app {

struct WaitFrames {
  std::int64_t frames;
};
struct WaitDone {};
struct Screenshot {
  std::string path;
};
struct Quit {};

struct ScriptStep {
  int line = 0;  ///< from 1
  std::variant<Change, WaitFrames, WaitDone, Screenshot, Quit> what;
};

/// Errors are ErrorKind::bad_input with file, line and field. Light names must be among the scene's.
Expected<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file,
                                               const std::vector<Light>& lights);

}  // namespace gnomon::app
