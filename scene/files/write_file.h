// Outputs appear whole under their final name or not at all.
#pragma once

#include <string>
#include <string_view>

#include "scene/expected.h"

namespace gnomon {

/// Writes to a temporary file beside `path`, flushes it to the disk, closes it and renames it. Errors are
/// ErrorKind::cannot_write; an existing file is then left as it was, and the temporary file is gone. What is
/// not a plain file (a device, a pipe) is written to directly. Past a file-size limit this is an error, not a
/// signal.
Expected<void> write_file(const std::string& path, std::string_view bytes);

/// Writes over the end of a file that write_file() wrote, in its place and without waiting for the disk: after
/// a cut of power parts of the old end may stand there. ErrorKind::cannot_write.
Expected<void> write_over_end(const std::string& path, std::string_view end);

/// Whether two paths lead to one file, which need not exist yet; a device is nobody's.
bool is_same_file(const std::string& a, const std::string& b);

/// Creates the folder (and its parents) and checks that files can be written in it.
Expected<void> make_output_folder(const std::string& path);

}  // namespace gnomon
