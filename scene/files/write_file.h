// Outputs appear whole under their final name or not at all.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/base/expected.h"
#include "scene/files/new_file.h"

namespace gnomon {

/// Writes to a temporary file beside `path`, flushes it to the disk, closes it and renames it. Errors are
/// ErrorKind::cannot_write; an existing file is then left as it was, and the temporary file is gone. What is
/// not a plain file (a device, a pipe) is written to directly. Past a file-size limit this is an error, not a
/// signal.
Expected<void> write_file(const std::string& path, std::string_view bytes);

/// Writes likewise to the file `name` ("cells/1.png") in a folder, where the program itself chose that name. No link in the
/// folder is followed, and one that has the file's name is replaced.
Expected<void> write_file_in(const std::string& folder, const std::string& name, std::string_view bytes);
/// Makes a folder in an output folder unless it is there, and checks that files can be written in it. A link of that name
/// is an error. ErrorKind::cannot_write.
Expected<void> make_output_subfolder(const std::string& folder, const std::string& name);

/// Writes over the end of a file that write_file() wrote, in its place and without waiting for the disk. After
/// a cut of power parts of the old end may stand there. ErrorKind::cannot_write.
Expected<void> write_over_end(const std::string& path, std::string_view end);

/// Returns what a path leads to. A link that leads nowhere is a place itself. ErrorKind::cannot_write.
Expected<std::string> follow_link(const std::string& path);

/// Whether two paths lead to one file, which need not exist yet; a device is nobody's.
bool is_same_file(const std::string& a, const std::string& b);

/// Creates the folder (and its parents) and checks that files can be written in it; else none of them stays. Those that it
/// made are added to `made`, the outermost first.
Expected<void> make_output_folder(const std::string& path, std::vector<std::string>* made = nullptr);
/// Makes the folder that the file is to lie in, to be called when the file is about to be written.
Expected<void> make_folder_for(const std::string& path);

/// Makes a file in the folder: permissions alone do not tell. Nothing is left behind. ErrorKind::cannot_write, also where
/// the umask would take the file away from the user.
Expected<void> check_takes_files(const std::string& folder);

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
    return number < 0 || ::close(number) == 0 || errno == EINTR;  // it is closed after a signal, too
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
  /// Behind what is there.
  Expected<void> append(std::string_view bytes);
  /// Over what is there, from its first byte on.
  Expected<void> write_over_begin(std::string_view bytes);
  Expected<void> publish();
  /// Puts it, with all else as it would be, in another place on the same file system.
  Expected<void> publish_at(const std::string& place);

 private:
  Expected<void> finish();
  PartFile(std::string target, NewFile file) : target_(std::move(target)), file_(std::move(file)) {}
  Expected<void> write_from(int whence, std::string_view bytes);
  std::string target_;
  NewFile file_;
};

}  // namespace gnomon
