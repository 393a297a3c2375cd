// A file in the making, beside the one whose name it will have. A name that is taken is nobody's loss: another is used.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "scene/files/folder.h"

namespace gnomon {

/// All errors are ErrorKind::cannot_write.
class NewFile {
 public:
  enum class Name : std::uint8_t { none_if_possible, temporary };
  /// Makes an empty file in the folder, to write and to read. It has the name NAME.PROCESS-COUNT.part, with up to 100 bytes of
  /// `name`, or none until it gets its own, where the file system knows such files.
  static Expected<NewFile> make(Folder folder, std::string name, Name has, mode_t mode = 0666);
  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&& other) noexcept;
  /// Removes what did not get its own name.
  ~NewFile();

  int descriptor() const { return descriptor_; }
  const Folder& folder() const { return folder_; }
  /// Waits until the disk has it, and closes it where it has a name already.
  Expected<void> flush();
  /// Gives it its name in place of what has that, which is not followed if it is a link.
  Expected<void> publish() { return publish(folder_, name_); }
  /// Gives it another name, in another folder of the file system.
  Expected<void> publish(const Folder& folder, const std::string& name);
  /// Removes it, and tells where that fails.
  Expected<void> remove();

 private:
  NewFile(Folder folder, std::string name) : folder_(std::move(folder)), name_(std::move(name)) {}
  /// Tries `use` with one unused name after the other.
  template <class Use>
  int with_temporary_name(const Use& use);
  tl::unexpected<Error> failed(std::string_view step) const;
  Folder folder_;
  std::string name_, temporary_;  ///< temporary_: the name that it has now, if any
  int descriptor_ = -1;
};

/// The name of the file that a process of this program was writing when it left a file in the making called `name`, and is
/// no more. Empty for every other name, and while the process lives, unless it is this one.
std::string abandoned_part_of(std::string_view name);
/// The file's name in an output's folder where it must have one, as abandoned_part_of() gives it.
inline constexpr std::string_view probe_name = "probe";

}  // namespace gnomon
