// What becomes of memory that was freed. The C library hands large blocks back to the system at once, which
// clears their pages again for the next picture of the same size; and it keeps an arena for each thread, from which no
// other thread takes what was freed, and which maps blocks above 64 MB one by one.
#pragma once

namespace gnomon {

/// From now on freed blocks are kept for the next ones, whatever their size, and four threads share an arena. Nothing
/// where the C library has no such choice.
void keep_freed_memory();

/// Hands back what is kept.
void return_freed_memory();

}  // namespace gnomon
