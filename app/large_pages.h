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

}  // namespace gnomon::app
