// The options that say what is compared: those that `compare` takes once and `sweep` and `tune` vary.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/options/pose_options.h"
#include "studies/sweep/engine.h"

namespace gnomon::app {

struct SettingOptions {
  compare::CompareOptions options;
  std::string light;  ///< name of the one light to compare; empty: all
  PoseOptions poses;
};

/// --size, the map's options, --light, the poses, the ray tracer's options.
void add_setting_options(CLI::App& command, SettingOptions& setting);

/// What a comparison needs to know. `given` is the scene as it was loaded.
Expected<compare::Setting> resolve_setting(const SettingOptions& setting, const Scene& given,
                                           const World& world);

}  // namespace gnomon::app
