#include "scene/files/staged_folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <mutex>
#include <new>
#include <optional>
#include <random>
#include <set>
#include <string_view>
#include <utility>

#include "scene/files/folder.h"
#include "scene/files/path_status.h"
#include "scene/files/publication.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

/// A staged folder's name is this, a number and ".part". One in a folder that is there lies in it, one of a folder that is
/// not there yet beside it.
std::string prefix_in_it() {
  return ".gnomon.";
}
std::string prefix_beside(const fs::path& folder) {
  constexpr std::size_t longest = 100;  // of 255 bytes that a file system takes
  return folder.filename().string().substr(0, longest) + prefix_in_it();
}

std::string parent_of(const fs::path& folder) {
  return folder.has_parent_path() ? folder.parent_path().string() : ".";
}

bool is_staged_name(std::string_view name, std::string_view prefix) {
  constexpr std::string_view end = ".part";
  if (!name.starts_with(prefix) || !name.ends_with(end) || name.size() <= prefix.size() + end.size())
    return false;
  const std::string_view number = name.substr(prefix.size(), name.size() - prefix.size() - end.size());
  return number.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_of(const Folder& opened, const Folder& place, const std::string& name) {
  const auto own = opened.itself();
  const auto there = place.find(name);
  return own && there && *there && own->st_dev == (*there)->st_dev && own->st_ino == (*there)->st_ino;
}

using FileId = std::pair<dev_t, ino_t>;

/// None where nothing is there: what is not there cannot be lost.
Expected<std::optional<FileId>> file_id(const std::string& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) == 0) return FileId{status.st_dev, status.st_ino};
  if (errno == ENOENT || errno == ENOTDIR) return std::nullopt;
  return failed_call(ErrorKind::cannot_write, path, "cannot be looked at", errno);
}

Expected<std::set<FileId>> file_ids(std::span<const std::string> paths) {
  std::set<FileId> ids;
  for (const std::string& path : paths) {
    const auto id = file_id(path);
    if (!id) return fail(id.error());
    if (*id) ids.insert(**id);
  }
  return ids;
}

Expected<void> check_targets(const fs::path& folder, const std::vector<std::string>& files,
                             std::span<const std::string> inputs) {
  const auto ids = file_ids(inputs);
  if (!ids) return fail(ids.error());
  for (const std::string& file : files) {
    const std::string target = (folder / file).string();
    const auto kind = file_kind(target, ErrorKind::cannot_write);
    if (!kind) return fail(kind.error());
    if (*kind == FileKind::folder)
      return fail(Error{ErrorKind::cannot_write, "cannot write: it is a folder", target});
    const auto id = file_id(target);
    if (!id) return fail(id.error());
    if (*id && ids->contains(**id))
      return fail(ErrorKind::usage,
                  fmt::format("-o: this file is also an input, which would be lost (got {})", target));
  }
  return {};
}

}  // namespace

/// A staged folder, wherever the object that has it moves.
struct StagedFolder::Held {
  std::string folder;  ///< for which it is
  Folder place;        ///< in which it lies: the folder itself, or the one around it
  std::string name;    ///< in `place`
  Folder staged;
  FolderLock lock;  ///< of the staged folder, while this process lives
  uid_t owner = 0;
  bool beside = false;               ///< the folder was not there yet
  std::vector<std::string> files{};  ///< names in it, from seal() on
  std::optional<Folder> target{};
  std::optional<Publication> moves{};
  FolderLock turn{};    ///< of the target, while files move
  bool moving = false;  ///< it holds what belongs into its folder
  bool gone = false;    ///< nothing is left to be removed

  Expected<void> begin(const std::string& last);
  Expected<void> finish(const std::string& last);
  Expected<void> undo();
  Expected<void> remove();
};

namespace {

/// The staged folders of this process, and what it left alone.
struct LivingFolders {
  std::mutex mutex;
  std::set<void*> held;
  std::vector<std::string> left_alone;
};
LivingFolders& living_folders() {
  static LivingFolders folders;
  return folders;
}

void leave_alone(const std::string& path, const std::string& why) {
  const std::lock_guard lock(living_folders().mutex);
  std::vector<std::string>& all = living_folders().left_alone;
  const std::string text = path + " (" + why + ")";
  if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
}

enum class Clear : std::uint8_t { unpublished, all };

/// Removes what a killed process left by that name, if it is the user's own.
void clear_abandoned(const Folder& place, const std::string& name, uid_t owner, Clear which) {
  constexpr const char* others = "another user's";
  const auto found = place.find(name);
  if (!found || !*found) return;
  if (!S_ISDIR((*found)->st_mode))
    return leave_alone(place.path_of(name), S_ISLNK((*found)->st_mode) ? "a link" : "no folder");
  const auto staged = place.below(name);
  const bool is_others = (*found)->st_uid != owner;
  if (!staged) {  // gone by now, or closed to this user
    const auto still = place.find(name);
    if (still && *still && (*still)->st_ino == (*found)->st_ino)
      leave_alone(place.path_of(name), is_others ? others : staged.error().message());
    return;
  }
  const FolderLock lock = FolderLock::of(*staged);
  // Its process lives, or nobody can say; or another has that name by now.
  if (!lock.held() || !is_of(*staged, place, name)) return;
  if (is_others) return leave_alone(place.path_of(name), others);
  // What a publication replaced and a broken disk kept from going back is of use until a whole new result is there.
  const auto replaced = staged->find(replaced_name);
  if (which == Clear::unpublished && (!replaced || *replaced)) return;
  if (auto gone = remove_tree(place, name, owner); !gone)
    leave_alone(place.path_of(name), gone.error().message());
}

void clear_abandoned(const std::string& folder, uid_t owner, Clear which) {
  const fs::path target(folder);
  for (const auto& [where, prefix] :
       {std::pair(parent_of(target), prefix_beside(target)), std::pair(folder, prefix_in_it())}) {
    const auto place = Folder::at(where);
    if (!place) continue;
    const auto names = place->names();
    if (!names)
      continue;  // who may write into a folder may still not list it; then nothing is known to be abandoned
    for (const std::string& name : *names)
      if (is_staged_name(name, prefix)) clear_abandoned(*place, name, owner, which);
  }
}

/// A number that nobody knows beforehand, where the process's own is taken.
std::uint64_t staged_number(int attempt) {
  if (attempt == 0) return static_cast<std::uint64_t>(::getpid());
  std::random_device random;
  return (std::uint64_t{random()} << 32U) | random();
}

}  // namespace

Expected<void> StagedFolder::Held::begin(const std::string& last) {
  auto opened = Folder::at(folder);
  if (!opened) return fail(opened.error());
  target = std::move(*opened);
  auto taken = FolderLock::waited_for(*target);  // others put their files here at the same time
  if (!taken) return fail(taken.error());
  turn = std::move(*taken);
  auto plan = Publication::plan(*target, staged, files, last);
  if (!plan) return fail(plan.error());
  moves = std::move(*plan);
  moving = true;
  return moves->begin();
}

Expected<void> StagedFolder::Held::finish(const std::string& last) {
  if (beside && !moves) {  // one rename, where nothing or an empty folder is in the way
    const std::string own = fs::path(folder).filename().string();
    gone = ::renameat(place.descriptor(), name.c_str(), place.descriptor(), own.c_str()) == 0;
    if (gone) return {};
    if (errno != EEXIST && errno != ENOTEMPTY)
      return failed_call(ErrorKind::cannot_write, folder, "cannot rename the finished folder", errno);
    if (auto begun = begin(last); !begun) return begun;
  }
  return moves->finish();
}

Expected<void> StagedFolder::Held::undo() {
  if (!moving) return {};
  if (auto undone = moves->undo(); !undone)
    return fail(
        Error{ErrorKind::cannot_write,
              fmt::format("older files could not be put back either ({}) and lie in {}/{}, until a whole "
                          "new result is in this folder",
                          undone.error().message(), staged.path(), replaced_name)});
  moving = false;
  return {};
}

Expected<void> StagedFolder::Held::remove() {
  if (moving || gone) return {};
  auto removed = remove_tree(place, name, owner);
  if (!removed) removed = remove_tree(place, name, owner);  // a disk that stumbled once
  gone = removed.has_value();
  return removed;
}

StagedFolder::StagedFolder(std::unique_ptr<Held> held) : held_(std::move(held)) {
  const std::lock_guard lock(living_folders().mutex);
  living_folders().held.insert(held_.get());
}

StagedFolder::StagedFolder(StagedFolder&& other) noexcept = default;

StagedFolder::~StagedFolder() {
  if (!held_) return;
  try {
    (void)held_->remove();
  } catch (const std::bad_alloc&) {  // there may be memory again, now that the stack is unwound
    (void)held_->remove();
  }
  const std::lock_guard lock(living_folders().mutex);
  living_folders().held.erase(held_.get());
}

const std::string& StagedFolder::path() const {
  return held_->staged.path();
}

const std::string& StagedFolder::folder() const {
  return held_->folder;
}

void StagedFolder::remove_all_at_the_end() {
  living_folders().mutex.lock();
  for (void* const held : living_folders().held) (void)static_cast<Held*>(held)->remove();
}

std::vector<std::string> StagedFolder::left_alone() {
  const std::lock_guard lock(living_folders().mutex);
  return std::exchange(living_folders().left_alone, {});
}

Expected<StagedFolder> StagedFolder::open(const std::string& folder) {
  fs::path target = fs::path(folder).lexically_normal();
  if (!target.has_filename() && target.has_relative_path()) target = target.parent_path();
  const auto exists = is_there(target.string(), ErrorKind::cannot_write);
  if (!exists) return fail(exists.error());
  const std::string where = *exists ? target.string() : parent_of(target);
  if (auto made = make_output_folder(where); !made) return fail(made.error());
  const auto place = Folder::at(where);
  if (!place) return fail(place.error());
  const auto own = try_new_file(*place);
  if (!own) return fail(own.error());
  clear_abandoned(target.string(), own->st_uid, Clear::unpublished);
  const std::string prefix = *exists ? prefix_in_it() : prefix_beside(target);
  constexpr int most = 100;  // names that somebody has taken, or folders that others took for abandoned ones
  for (int attempt = 0;; ++attempt) {
    const std::string name = fmt::format("{}{}.part", prefix, staged_number(attempt));
    if (::mkdirat(place->descriptor(), name.c_str(), 0777) != 0) {
      if (errno == EEXIST && attempt < most) continue;
      return failed_call(ErrorKind::cannot_write, place->path_of(name), "cannot create the folder", errno);
    }
    auto staged = StagedFolder::hold(target.string(), *place, name, own->st_uid, !*exists);
    if (!staged || *staged || attempt == most) {
      if (!staged) return fail(staged.error());
      if (*staged) return std::move(**staged);
      return fail(Error{ErrorKind::cannot_write, "others remove it again and again", place->path_of(name)});
    }
  }
}

/// Until it is locked, another process that starts may take the new folder for an abandoned one. None: one did.
Expected<std::optional<StagedFolder>> StagedFolder::hold(const std::string& folder, const Folder& place,
                                                         const std::string& name, uid_t owner, bool beside) {
  const auto give_up = [&](Error error) {
    ::unlinkat(place.descriptor(), name.c_str(), AT_REMOVEDIR);
    return fail(std::move(error));
  };
  const auto found = place.find(name);
  if (!found) return give_up(found.error());
  if (!*found) return std::nullopt;
  if (auto fine = check_umask_leaves(0700, (*found)->st_mode, place.path_of(name)); !fine)
    return give_up(fine.error());
  auto opened = place.below(name), around = place.below("");
  if (!around) return give_up(around.error());
  if (!opened) {
    const auto still = place.find(name);
    if (still && !*still) return std::nullopt;
    return give_up(opened.error());
  }
  auto lock = FolderLock::waited_for(*opened);
  if (!lock) return give_up(lock.error());
  if (!is_of(*opened, place, name)) return std::nullopt;
  const auto made = opened->itself();
  if (!made) return give_up(made.error());
  if (made->st_uid != owner)
    return fail(Error{ErrorKind::cannot_write, "another user has put a folder in the place of this one",
                      opened->path()});
  return StagedFolder(std::make_unique<Held>(
      Held{folder, std::move(*around), name, std::move(*opened), std::move(*lock), owner, beside}));
}

Expected<void> StagedFolder::seal(std::span<const std::string> inputs) {
  auto files = files_below(path(), ErrorKind::cannot_write);
  if (!files) return fail(files.error());
  held_->files = std::move(*files);
  if (auto fine = check_targets(held_->folder, held_->files, inputs); !fine) return fine;
  return held_->staged.flush();
}

Expected<void> StagedFolder::publish(const std::string& last) {
  const Part alone{this, last};
  return publish(std::span(&alone, 1));
}

/// A folder that appears by one rename comes last: that is never undone.
Expected<void> StagedFolder::move_all(std::span<const Part> parts) {
  for (const Part& part : parts)
    if (!part.folder->held_->beside)
      if (auto begun = part.folder->held_->begin(part.last); !begun) return begun;
  for (const bool beside : {false, true})
    for (const Part& part : parts)
      if (part.folder->held_->beside == beside)
        if (auto finished = part.folder->held_->finish(part.last); !finished) return finished;
  return {};
}

/// Memory that is missing is an error like others here: what has moved has to go back.
Expected<void> StagedFolder::publish(std::span<const Part> parts) {
  Expected<void> moved;
  try {
    moved = move_all(parts);
  } catch (const std::bad_alloc&) {
    moved = fail(ErrorKind::graphics, "out of memory");
  }
  for (const Part& part : parts)
    if (!moved)
      if (auto undone = part.folder->held_->undo(); !undone)
        moved.error().reason += "; " + undone.error().reason;
  if (!moved) return moved;
  Expected<void> whole;
  for (const Part& part : parts) {
    Held& held = *part.folder->held_;
    held.moving = false;
    if (held.moves) held.moves->drop_older();
    if (auto gone = held.remove(); !gone && whole) {
      whole = gone;
      whole.error().reason =
          fmt::format("is left over ({}); the new files are all in their places, so it can be removed",
                      gone.error().reason);
    }
    held.turn = {};
    if (!held.beside) clear_abandoned(held.folder, held.owner, Clear::all);
  }
  return whole;
}

}  // namespace gnomon
