// Links in an output folder, where another program or another process would follow them.
#pragma once

#include <string>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

/// Refuses names in the folder that are links. ErrorKind::cannot_write.
Expected<void> refuse_links(const std::string& folder, const std::vector<std::string>& names);

}  // namespace gnomon
