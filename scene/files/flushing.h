// Whether a file that was written waits for the disk.
#pragma once

namespace gnomon {

/// From here on none does, in the whole process: what it writes is read at once and then removed, so that nobody misses it
/// where the machine loses its power.
void leave_flushing_to_the_system();
/// True at first.
bool is_flushing();

}  // namespace gnomon
