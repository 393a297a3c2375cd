// Finished files that move from a staged folder into a folder that has files already, all of them or none. What they
// replace is kept aside in the staged folder until the last of them is in its place, and a list of them all is written
// there first: when a step fails, every step before it is undone, and when the process is killed, the next one that
// publishes into the folder reads the list and does that.
#pragma once

#include <span>
#include <string>

#include "scene/expected.h"

namespace gnomon {

/// Moves `files` (names in `staged`, `last` among them) into `folder`, on the same file system. What has the name of
/// `last` there is taken away first, and `last` is put there last: a folder which has it is never a mixture. Errors are
/// ErrorKind::cannot_write and say so where the older files could not be put back; is_unfinished_publication() then.
Expected<void> publish_into(const std::string& folder, const std::string& staged,
                            std::span<const std::string> files, const std::string& last);

/// Whether the staged folder holds what belongs into its folder: older files that were not put back.
bool is_unfinished_publication(const std::string& staged);

/// Undoes what a killed process began. A file that somebody else has put in the place of one of its files stays.
Expected<void> undo_publication(const std::string& folder, const std::string& staged);

}  // namespace gnomon
