// Large pages for all that the process allocates. Where the system gives them only to those who ask (Linux's
// transparent huge pages under "madvise"), glibc's allocator asks when its tunables say so before the process starts
// (the GNU C Library manual, "Memory Allocation Tunables"). On virtual machines, where the first touch of a page is dear,
// a whole comparison takes up to half the time with them.
#pragma once

#include <string_view>

namespace gnomon::app {

/// Starts the program once more with that tunable, before it has done anything else; returns where that is not needed or
/// cannot be done. GLIBC_TUNABLES that are set already are the user's, and stay.
void start_with_large_pages(char** argv);

/// Whether the system's choice, as /sys/kernel/mm/transparent_hugepage/enabled gives it ("always [madvise] never"), is to
/// give large pages to those who ask.
bool are_asked_for(std::string_view choices);

// What becomes of the program when a library cannot start a thread (a limit on processes, ulimit -u). The program tries
// beforehand how many it can have (limit_threads() in session.h, image_library()); what it finds may have changed by the time
// that they are started.

/// To be called first. From here on, a thread that is refused where nothing else can be done ends the process with
/// ErrorKind::graphics and one line, instead of an abort, an exception out of a library or a wait for ever.
void end_in_words_without_threads();

}  // namespace gnomon::app
