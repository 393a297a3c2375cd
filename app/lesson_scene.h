// A lesson's name as SCENE: the scene of the lesson's first command, with that command's settings where the
// command line gives none of its own. `gnomon compare acne` is `gnomon compare acne-floor --bias 0 …`.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace gnomon::app {

/// The built-in scene that the lesson of that name looks at; any other text comes back as it is.
std::string scene_of_lesson(const std::string& path_or_name);
/// What to tell a user who named a lesson; empty for any other text.
std::string lesson_note(const std::string& path_or_name);

/// Gives a parsed command whose SCENE is a lesson's name the lesson's settings: those options of the lesson's
/// command that it knows and was not given. None when it was given --technique, to whose settings the
/// lesson's need not belong. Throws CLI::ParseError when a value does not parse.
void add_lesson_settings(CLI::App& command);

}  // namespace gnomon::app
