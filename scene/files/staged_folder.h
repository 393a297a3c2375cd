// A folder of outputs that appears whole: its files are written beside it and then renamed. A new folder
// appears by one rename. Into one that exists its files move one by one, after all of them have reached the
// disk (scene/files/staged_folder.h): the last of them (the page) is taken away first and put back last, so that a
// folder which has it is never a mixture; when a step fails, or the process is killed, the older files come back;
// processes that come at the same time take turns. What else lies in the folder stays. Nobody waits until the disk
// has the new names too: after a cut of power the folder is the old one or the new one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

class StagedFolder {
 public:
  /// Also undoes what a killed process began in that folder, and removes what it left. ErrorKind::cannot_write.
  static Expected<StagedFolder> open(const std::string& folder);
  StagedFolder(StagedFolder&& other) noexcept;
  StagedFolder& operator=(StagedFolder&&) = delete;
  /// Removes what was not published.
  ~StagedFolder();

  /// Where the files are written until they are published.
  const std::string& path() const { return path_; }
  /// Once every file is there: looks where they will go and waits until the disk has them all. Errors:
  /// ErrorKind::usage when a file would take the place of one of `inputs`, ErrorKind::cannot_write.
  Expected<void> seal(std::span<const std::string> inputs);
  /// After seal(): the renaming alone. `last` is the name of the file that shows a whole folder. Errors:
  /// ErrorKind::cannot_write; the folder is then as it was.
  Expected<void> publish(const std::string& last);

  /// Removes all that this process has not published, before it ends where it stands. None can be opened any more: who
  /// tries waits.
  static void remove_all_at_the_end();

 private:
  StagedFolder(std::string folder, std::string path);
  void forget();
  std::string folder_, path_;
  std::vector<std::string> files_;  ///< names in path_, from seal() on
  bool published_ = false;          ///< what is left in path_ is of no use
  int lock_ = -1;                   ///< of the staged folder, held while this process lives
};

// Finished files that move from a staged folder into a folder that has files already, all of them or none. What they
// replace is kept aside in the staged folder until the last of them is in its place, and a list of them all is written
// there first: when a step fails, every step before it is undone, and when the process is killed, the next one that
// publishes into the folder reads the list and does that.

/// Moves `files` (names in `staged`, `last` among them) into `folder`, on the same file system. What has the name of
/// `last` there is taken away first, and `last` is put there last: a folder which has it is never a mixture. Errors are
/// ErrorKind::cannot_write and say so where the older files could not be put back; is_unfinished_publication() then.
Expected<void> publish_into(const std::string& folder, const std::string& staged,
                            std::span<const std::string> files, const std::string& last);

/// Whether the staged folder holds what belongs into its folder: older files that were not put back.
bool is_unfinished_publication(const std::string& staged);

/// Undoes what a killed process began. A file that somebody else has put in the place of one of its files stays.
Expected<void> undo_publication(const std::string& folder, const std::string& staged);

}  // namespace gnomon
