// Single files that one run writes, and its folder if it has one: they appear together or not at all. Each is written in a
// staged folder beside its place (scene/files/staged_folder.h), with permissions and links kept as write_file() keeps them.
#pragma once

#include <sys/types.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/files/staged_folder.h"

namespace gnomon {

/// What goes into a file. An empty path is none.
struct FileText {
  std::string path, bytes;
};

/// All errors are ErrorKind::cannot_write.
class StagedFiles {
 public:
  StagedFiles() = default;
  StagedFiles(StagedFiles&&) = default;
  StagedFiles& operator=(StagedFiles&&) = delete;
  /// Removes what was not published, and the folders made for it.
  ~StagedFiles();

  /// Returns where to write the file that is to appear at `path`, with the same extension, and makes the folder that it is to
  /// lie in. One that lies in `folder` is written there. The path itself: what is there is no plain file (a device, a pipe).
  Expected<std::string> place_of(const std::string& path, const StagedFolder* folder = nullptr);
  /// Writes a file; what is no plain file is written when all others are in their places.
  Expected<void> write(const FileText& file, const StagedFolder* folder = nullptr);
  /// Waits until the disk has them all.
  Expected<void> seal();
  /// Where the file of a place that place_of() returned lies once all are sealed.
  std::string sealed_place(const std::string& place) const;
  /// Publishes them, and with them a sealed folder whose last file is `last`.
  Expected<void> publish(StagedFolder* folder = nullptr, const std::string& last = {});
  /// Writes some, seals and publishes all of them with a folder, in which no file may take the place of one of `inputs`.
  Expected<void> publish(StagedFolder& folder, const std::string& last, std::span<const std::string> inputs,
                         std::span<const FileText> texts);

 private:
  struct Place {
    std::string folder;  ///< its whole path
    StagedFolder staged;
  };
  Expected<const StagedFolder*> staged_for(const std::string& folder);
  std::vector<std::string> made_;  ///< folders, the outermost first
  std::vector<Place> places_;
  /// A file that a link leads to is staged by the link's name; one that is there keeps its permissions.
  struct Finish {
    std::string staged, named;  ///< paths
    std::optional<mode_t> permissions;
  };
  std::vector<Finish> finishes_;
  std::vector<FileText> direct_;  ///< no plain files, and what they get
};

}  // namespace gnomon
