// A lesson's name as SCENE: the scene of the lesson's first command, with that command's settings where the
// command line gives none of its own. `gnomon compare acne` is `gnomon compare acne-floor --bias 0 …`.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/outputs/run_files.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// The built-in scene that the lesson of that name looks at; any other text comes back as it is.
std::string scene_of_lesson(const std::string& path_or_name);
/// What to tell a user who named a lesson; empty for any other text.
std::string lesson_note(const std::string& path_or_name);
/// Tells what a parsed command does with the settings of a scene.
SettingsUse use_of_settings(const CLI::App& command);
/// What becomes of the settings of a lesson or a scene file; empty where there are none.
std::string settings_note(const SceneArgument& scene);

/// "--bias 0": what a scene file asks for; empty for others.
std::string scene_settings_text(const std::string& path_or_name);

/// Options by name, as compare's command line has them; a switch is "on" or "off".
using OptionValues = std::vector<std::pair<std::string, std::string>>;
/// Returns the values, which name one technique at most. Beside them it returns those that a lesson or a scene file
/// would set otherwise. A command with all of them draws what `values` alone draw.
OptionValues settled_values(const std::string& path_or_name, OptionValues values);

/// Gives a parsed command the settings that its scene file asks for (scene/load.h): those of the shadow map's
/// options that it knows and was not given. None when it was given another technique, as below; no bias where it
/// was given one of any kind; nothing to `tune`, which finds them. For each option that was set ("--bias"), the place of
/// its value in the file, as an error without a reason. Error (bad_input): an option that the shadow map has not, or a
/// value that it does not take.
Expected<std::map<std::string, Error>> add_scene_settings(CLI::App& command);

/// Gives a parsed command whose SCENE is a lesson's name the lesson's settings: those options of the lesson's
/// command that it knows and was not given. None when it was given another technique, to whose settings the
/// lesson's need not belong; none of the map's to `tune`, which finds them; none of a film's where errors are not
/// flips. Throws CLI::ParseError when a value does not parse.
void add_lesson_settings(CLI::App& command);

}  // namespace gnomon::app
