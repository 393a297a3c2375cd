// What a script's `set` knows beside the options of the shadow map: each key with its values as a change.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/view/state.h"

namespace gnomon::app {

struct ScriptKey {
  std::string_view name;
  std::size_t values;
  std::string_view usage;
  /// As many values as are wanted. Error (usage): not such a value.
  Expected<Change> (*read)(const std::vector<std::string>& values);
};

/// Null when there is none.
const ScriptKey* find_script_key(std::string_view name);
/// All of them, and "light", which needs the scene.
std::vector<std::string> script_key_names();

}  // namespace gnomon::app
