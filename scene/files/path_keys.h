// Paths by keys as JSON says them, in files of their own and in scenes.
#pragma once

#include "scene/files/json_reader.h"
#include "scene/keyed_path.h"

namespace gnomon {

/// The members "camera" and "lights" of a path.
void read_path_keys(const JsonObject& object, KeyedPath& path);

}  // namespace gnomon
