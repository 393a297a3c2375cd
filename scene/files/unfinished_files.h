// What becomes of files in the making (scene/files/new_file.h) when the process ends where it stands.
#pragma once

namespace gnomon {

/// Removes all that did not get their own names yet, and needs no memory for it. None can be made any more: who tries waits.
void remove_unfinished_files();

}  // namespace gnomon
