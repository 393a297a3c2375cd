// A setting of the map as a page knows it, to make a control for it (report/page/src/lab/settings_panel.ts): in the lab, and
// beside a lesson's figure.
#pragma once

#include <nlohmann/json.hpp>

#include "raster/settings.h"

namespace gnomon::lab {

/// Name, group, title, notes, who reads it, and what a control of its kind needs.
nlohmann::ordered_json setting_facts(const raster::MapSetting& row);

/// The settings that the technique reads, with their values as the command line takes them.
nlohmann::ordered_json setting_values(const raster::MapOptions& map);

}  // namespace gnomon::lab
