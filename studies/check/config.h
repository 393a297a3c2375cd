// gnomon.toml: the scenes of a repository, how each is drawn and seen, and what it is held against. docs/ci.md shows one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon::studies {

/// A value with where it stands. `text` is as an option takes it: "2048", "on", "1024,2048" of a list.
struct ConfigValue {
  std::string key, text;
  std::string field;  ///< "scene[2].settings.map-size"
  int line = 0, column = 0;
};

/// One comparison: a scene from one view. What stands nearest to it wins.
struct CheckRun {
  std::string name;   ///< of its folder: of the scene, "hall", or with the view's, "hall-door"
  std::string scene;  ///< a file beside the configuration, or a built-in scene
  ConfigValue place;  ///< of the scene
  std::vector<ConfigValue> settings, limits;
};

struct CheckConfig {
  std::string path;
  std::optional<std::string> baseline;  ///< a folder beside the configuration
  std::vector<CheckRun> runs;

  Error wrong(const ConfigValue& value, std::string reason) const;
};

/// What limits there are: fail-above, fail-worse.
bool is_limit(const std::string& key);

/// Unknown keys are errors with a hint; the keys of settings are checked by who knows the options. ErrorKind::bad_input.
Expected<CheckConfig> read_check_config(const std::string& path);

}  // namespace gnomon::studies
