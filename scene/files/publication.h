// Finished files that move from a staged folder into one that has files already. What they replace is kept aside in the
// staged folder until all is in its place. Memory alone knows what has moved. When a step fails, every step before it is
// undone. Nothing is written down for another process to believe. A process that is killed in between leaves a folder
// without the file that shows a whole one, which is taken away first and put there last.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/files/folder.h"

namespace gnomon {

/// In a staged folder: the folder of what was replaced.
inline constexpr const char* replaced_name = ".replaced";

/// All errors are ErrorKind::cannot_write. Both folders must live as long, on one file system.
class Publication {
 public:
  /// Looks at what is in the way. `last` is the name of the file that shows a whole folder; empty: there is none.
  static Expected<Publication> plan(const Folder& folder, const Folder& staged,
                                    std::span<const std::string> files, const std::string& last);
  /// Takes away what has the name of the last file, and moves all but that one.
  Expected<void> begin();
  Expected<void> finish();
  /// Undoes what was done. Whatever can be undone is; the error is that of the first step that cannot.
  Expected<void> undo();
  /// Lets go of what was replaced, whoever's it was. What stays is left to whoever removes the staged folder.
  void drop_older();

 private:
  struct File {
    std::string name;
    ino_t inode = 0;
    bool kept = false, moved = false;
  };
  /// The three folders that a name's last part lies in.
  struct Places {
    Folder to, from, aside;
  };
  Publication(const Folder& folder, const Folder& staged, Folder aside)
      : folder_(&folder), staged_(&staged), aside_(std::move(aside)) {}
  Expected<void> add(std::span<const std::string> files, const std::string& last);
  Expected<void> look_at_folders(const std::vector<std::string>& folders);
  Expected<Places*> places_of(const std::string& name);
  Expected<void> keep_aside(File& file, bool may_stay);
  Expected<void> move(File& file);
  Expected<void> undo(File& file);

  const Folder *folder_, *staged_;
  Folder aside_;
  std::vector<std::string> new_folders_, made_folders_;  ///< names in the folder, parents first
  std::vector<File> files_;
  bool has_last_ = false;  ///< the last of the files is the one that shows a whole folder
  std::string open_;       ///< the folder that `places_` is of
  std::optional<Places> places_;
};

}  // namespace gnomon
