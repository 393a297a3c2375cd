// What becomes of the program when a library cannot start a thread (a limit on processes, ulimit -u). The program tries
// beforehand how many it can have (limit_threads() in session.h, image_library()); what it finds may have changed by the time
// that they are started.
#pragma once

namespace gnomon::app {

/// To be called first. From here on, a thread that is refused where nothing else can be done ends the process with
/// ErrorKind::graphics and one line, instead of an abort, an exception out of a library or a wait for ever.
void end_in_words_without_threads();

}  // namespace gnomon::app
