// Outputs appear whole under their final name or not at all.
#pragma once

#include <unistd.h>
#include <string>
#include <string_view>
#include <utility>

#include "scene/base/expected.h"

namespace gnomon {

/// Writes to a temporary file beside `path`, flushes it to the disk, closes it and renames it. Errors are
/// ErrorKind::cannot_write; an existing file is then left as it was, and the temporary file is gone. What is
/// not a plain file (a device, a pipe) is written to directly. Past a file-size limit this is an error, not a
/// signal.
Expected<void> write_file(const std::string& path, std::string_view bytes);

/// The name of the file that a process of this program was writing when it left a temporary file called `name` (what
/// write_file() calls it: NAME.PROCESS-COUNT.part, with up to 100 bytes of the file's own name), and is no more. Empty for
/// every other name, and while the process lives, unless it is this one.
std::string abandoned_part_of(std::string_view name);

/// Writes over the end of a file that write_file() wrote, in its place and without waiting for the disk: after
/// a cut of power parts of the old end may stand there. ErrorKind::cannot_write.
Expected<void> write_over_end(const std::string& path, std::string_view end);

/// Whether two paths lead to one file, which need not exist yet; a device is nobody's.
bool is_same_file(const std::string& a, const std::string& b);

/// Creates the folder (and its parents) and checks that files can be written in it.
Expected<void> make_output_folder(const std::string& path);
/// Makes the folder that the file is to lie in, to be called when the file is about to be written.
Expected<void> make_folder_for(const std::string& path);

/// Makes a file in the folder, without a name where the file system knows such: permissions alone do not tell. Nothing is
/// left behind. ErrorKind::cannot_write.
Expected<void> check_takes_files(const std::string& folder);
/// The file's name in an output's folder where it must have one, as abandoned_part_of() gives it.
inline constexpr std::string_view probe_name = "probe";

// A file descriptor that closes itself.

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  /// For those who want to know whether that worked.
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_;
};

// Files that are written part by part.

/// A file that appears under its final name when it is published. It has no name before, where the file system knows such
/// files, so that nothing is left of it when the process ends. Errors are ErrorKind::cannot_write.
class PartFile {
 public:
  /// Empty, beside `path`. An error also where that is there and no plain file.
  static Expected<PartFile> create(const std::string& path);
  PartFile(PartFile&& other) noexcept { *this = std::move(other); }
  PartFile& operator=(PartFile&& other) noexcept;
  ~PartFile();
  /// Behind what is there.
  Expected<void> append(std::string_view bytes);
  /// Over what is there, from its first byte on.
  Expected<void> write_over_begin(std::string_view bytes);
  Expected<void> publish();

 private:
  PartFile() = default;
  Expected<void> write_from(int whence, std::string_view bytes);
  std::string target_, part_;
  int descriptor_ = -1;
};

}  // namespace gnomon
