// Whether two results show the same, so that their pixels can be held against each other, and what else is not as it was.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/diff/diff.h"

namespace gnomon::studies {

/// Why two documents cannot be compared; empty where they can. A scene is known by its file's bytes, whatever it is
/// called. With DiffOptions::changed_scene these may differ.
std::string why_not_comparable(const nlohmann::ordered_json& before, const nlohmann::ordered_json& after,
                               const DiffOptions& options);

/// What a reader of the verdict should know: another program, another machine, another precision.
std::vector<std::string> notes_on(const nlohmann::ordered_json& before, const nlohmann::ordered_json& after);

/// Settings of the maps that differ, those of all lights once where they are the same.
std::vector<ChangedSetting> changed_settings(const nlohmann::ordered_json& before,
                                             const nlohmann::ordered_json& after);

}  // namespace gnomon::studies
