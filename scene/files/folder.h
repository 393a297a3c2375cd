// Folders that are held open. A name in one is looked up from it and never through a link. Somebody may plant a link,
// or put another folder in its place meanwhile. That leads no write, rename or removal elsewhere.
#pragma once

#include <sys/stat.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

/// All errors are ErrorKind::cannot_write.
class Folder {
 public:
  /// Opens the folder at a path that a user named. Links on the way to it are followed, but none that is planted().
  static Expected<Folder> at(const std::string& path);
  /// Opens the folder "a/b" in this one ("": this one again). A link on the way is an error, whatever it leads to.
  Expected<Folder> below(const std::string& names) const;
  Folder(Folder&& other) noexcept
      : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
  Folder& operator=(Folder&& other) noexcept;
  ~Folder();

  const std::string& path() const { return path_; }  ///< for messages
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }
  int descriptor() const { return descriptor_; }

  /// Returns what is known of a name in it, of a link itself; none where nothing is there.
  Expected<std::optional<struct stat>> find(const std::string& name) const;
  /// Tells where the link of that name leads; none where it is no link. Error: it is planted (is_planted()).
  Expected<std::optional<std::string>> link_target(const std::string& name) const;
  /// Returns what is known of the folder itself.
  Expected<struct stat> itself() const;
  Expected<std::vector<std::string>> names() const;
  /// Waits until the disk has its names.
  Expected<void> flush() const;

 private:
  Folder(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  Expected<Folder> entered(const std::string& name) const;
  std::string path_;
  int descriptor_ = -1;
};

/// Whether somebody else may have put the thing there for others to stumble over. The folder is one in which all may write and
/// nobody may remove another's (sticky, as /tmp). The thing belongs neither to the user nor to the folder's owner. Linux has the
/// same rule where fs.protected_symlinks and fs.protected_fifos are on (man 5 proc).
bool is_planted(const struct stat& folder, const struct stat& thing);
/// Refuses what is planted by that name in the folder; nothing there is fine.
Expected<void> refuse_planted(const Folder& folder, const std::string& name);

/// "a/b" of "a/b/c", "" of "c".
std::string folder_part(const std::string& name);
/// "c" of "a/b/c".
std::string last_part(const std::string& name);

/// Makes the folder `name` ("a" where "a/b" is wanted comes first) unless it is there. Tells whether it made it.
Expected<bool> make_folder_in(const Folder& folder, const std::string& name);

/// Removes a file, a link or a folder with all that is in it, by a name in the folder; that it is not there is no error.
/// What does not belong to `owner`, and what lies on another file system, stays, with the folders around it.
Expected<void> remove_tree(const Folder& folder, const std::string& name, uid_t owner);

/// Makes a file in the folder, without a name where the file system knows such, and returns what is known of it. That
/// tells whose the new files are there, and that files can be made. Nothing is left behind. It is an error when the umask
/// takes from the user the right to read and write them.
Expected<struct stat> try_new_file(const Folder& folder);
/// The error that says so of a folder or file with such permissions.
Expected<void> check_umask_leaves(mode_t needed, mode_t got, const std::string& path);

/// A lock on a folder, which the system takes back when the process ends. None is held where the file system has no locks.
class FolderLock {
 public:
  FolderLock() = default;
  /// Takes it unless somebody else has it.
  static FolderLock of(const Folder& folder);
  /// Waits for others half a minute at most; an error then: who may read a folder may lock it for ever.
  static Expected<FolderLock> waited_for(const Folder& folder);
  FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FolderLock();
  bool held() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

}  // namespace gnomon
