// A folder of outputs that appears whole: its files are written beside it and then renamed. A new folder appears by one
// rename. Into one that exists its files move one by one, after all of them have reached the disk
// (scene/files/publication.h). The last of them (the page) is taken away first and put back last. So a folder which has it
// is never a mixture. When a step fails, the older files come back. Processes that come at the same time take turns. What
// else lies in the folder stays. Nobody waits until the disk has the new names too: after a cut of power the folder is the
// old one or the new one.
//
// A process that is killed between two renames leaves a folder without its page. No list on the disk says what it had moved,
// for whoever can write a folder could write such a list as well. The next run writes all again. (The whole folder could be
// exchanged by one rename, RENAME_EXCHANGE. That would give it another inode and other permissions, and leave a shell that
// stands in it in a deleted one. What else lies there would have to be carried over.)
#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/base/expected.h"
#include "scene/files/folder.h"

namespace gnomon {

class StagedFolder {
 public:
  /// Also removes what a killed process left, if that is this user's own. Errors: ErrorKind::cannot_write.
  static Expected<StagedFolder> open(const std::string& folder);
  StagedFolder(StagedFolder&& other) noexcept;
  StagedFolder& operator=(StagedFolder&&) = delete;
  /// Removes what was not published.
  ~StagedFolder();

  /// Where the files are written until they are published.
  const std::string& path() const;
  /// For which folder they are.
  const std::string& folder() const;
  /// Once every file is there: looks where they will go and waits until the disk has them all. Errors:
  /// ErrorKind::usage when a file would take the place of one of `inputs`, ErrorKind::cannot_write.
  Expected<void> seal(std::span<const std::string> inputs);
  /// After seal(): the renaming alone. `last` is the name of the file that shows a whole folder; empty: there is none.
  /// Errors: ErrorKind::cannot_write; the folder is then as it was.
  Expected<void> publish(const std::string& last);

  struct Part {
    StagedFolder* folder = nullptr;
    std::string last;
  };
  /// Publishes several, all of them or none.
  static Expected<void> publish(std::span<const Part> parts);

  /// Removes all that this process has not published, before it ends where it stands. None can be opened any more: who
  /// tries waits.
  static void remove_all_at_the_end();

  /// What had the name of a staged folder and was left alone, because it is not this user's own or no folder; each with the
  /// reason. Of all folders that this process opened since it was asked last.
  static std::vector<std::string> left_alone();

 private:
  struct Held;
  explicit StagedFolder(std::unique_ptr<Held> held);
  static Expected<std::optional<StagedFolder>> hold(const std::string& folder, const Folder& place,
                                                    const std::string& name, uid_t owner, bool beside);
  static Expected<void> move_all(std::span<const Part> parts);
  std::unique_ptr<Held> held_;
};

}  // namespace gnomon
