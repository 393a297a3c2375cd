#include "scene/files/staged_folder.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

/// In the staged folder: the list of what moves, and the folder of what was replaced.
constexpr std::string_view list_name = ".publishing", replaced_name = ".replaced";

/// A staged file, known again in its place by what a rename keeps.
struct MovingFile {
  std::string name;
  std::uint64_t inode = 0;
  std::int64_t modified_ns = 0;
};

struct Moves {
  std::string folder, staged;
  std::vector<std::string> new_folders;  ///< names in `folder`, parents first
  std::vector<MovingFile> files;         ///< the last of them is put in its place last
  std::string to(const std::string& name) const { return folder + "/" + name; }
  std::string from(const std::string& name) const { return staged + "/" + name; }
  std::string aside(const std::string& name) const {
    return fmt::format("{}/{}/{}", staged, replaced_name, name);
  }
  std::string list() const { return fmt::format("{}/{}", staged, list_name); }
};

tl::unexpected<Error> cannot_move(const std::string& path, std::string_view step) {
  return failed_call(ErrorKind::cannot_write, path, step, errno);
}

/// Returns what is known of a file or a link itself; none where nothing is there.
Expected<std::optional<struct stat>> what_is_at(const std::string& path) {
  struct stat found = {};
  if (::lstat(path.c_str(), &found) == 0) return found;
  if (errno == ENOENT || errno == ENOTDIR) return std::nullopt;
  return cannot_move(path, "cannot be looked at");
}

std::int64_t modified_ns(const struct stat& file) {
  return std::int64_t{file.st_mtim.tv_sec} * 1'000'000'000 + file.st_mtim.tv_nsec;
}

Expected<void> rename_file(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) return cannot_move(to, "cannot rename the finished file");
  return {};
}

Expected<void> make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0777) == 0) return {};
  const int why = errno;
  const auto there = is_folder(path, ErrorKind::cannot_write);
  if (there && *there) return {};
  errno = why;
  return cannot_move(path, "cannot create the folder");
}

/// "a" and "a/b" of "a/b/c".
void add_folders_of(const std::string& name, std::set<std::string>& folders) {
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 1))
    folders.insert(name.substr(0, at));
}

Expected<Moves> plan_moves(const std::string& folder, const std::string& staged,
                           std::span<const std::string> files, const std::string& last) {
  Moves moves{folder, staged, {}, {}};
  std::set<std::string> folders;
  for (const std::string& name : files) {
    const auto file = what_is_at(moves.from(name));
    if (!file) return fail(file.error());
    if (!*file) return fail(Error{ErrorKind::cannot_write, "a finished file is gone", moves.from(name)});
    moves.files.push_back({name, (*file)->st_ino, modified_ns(**file)});
    add_folders_of(name, folders);
  }
  std::stable_partition(moves.files.begin(), moves.files.end(),
                        [&](const MovingFile& file) { return file.name != last; });
  for (const std::string& name : folders) {
    const auto there = file_kind(moves.to(name), ErrorKind::cannot_write);
    if (!there) return fail(there.error());
    if (*there == FileKind::none) moves.new_folders.push_back(name);
    if (*there != FileKind::none && *there != FileKind::folder)
      return fail(Error{ErrorKind::cannot_write, "is not a folder", moves.to(name)});
    if (auto made = make_folder(moves.aside(name)); !made) return fail(made.error());
  }
  return moves;
}

// One record per folder and file, each with a zero byte at its end, which no name holds.
std::string list_text(const Moves& moves) {
  std::string text;
  for (const std::string& name : moves.new_folders) text += "folder " + name + '\0';
  for (const MovingFile& file : moves.files)
    text += fmt::format("{} {} {}", file.inode, file.modified_ns, file.name) + '\0';
  return text;
}

bool consume_number(std::string_view& text, auto& number) {
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  const auto length = static_cast<std::size_t>(end - text.data());
  if (status != std::errc() || length == text.size() || text[length] != ' ') return false;
  text.remove_prefix(length + 1);
  return true;
}

Expected<Moves> read_list(const std::string& folder, const std::string& staged) {
  Moves moves{folder, staged, {}, {}};
  const auto bytes = read_file(moves.list());
  if (!bytes) return fail(Error{ErrorKind::cannot_write, bytes.error().reason, bytes.error().file});
  constexpr std::string_view folder_word = "folder ";
  std::string_view rest = *bytes;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\0'), rest.size() - 1);
    std::string_view record = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    if (record.starts_with(folder_word)) {
      moves.new_folders.emplace_back(record.substr(folder_word.size()));
      continue;
    }
    MovingFile file;
    if (!consume_number(record, file.inode) || !consume_number(record, file.modified_ns))
      return fail(Error{ErrorKind::cannot_write, "is no list of files on their way", moves.list()});
    file.name = record;
    moves.files.push_back(std::move(file));
  }
  return moves;
}

enum class Place : std::uint8_t { stays_filled, is_emptied };

/// A second name where that will do and the file system has such, so that the first is never without its file.
Expected<void> keep_aside(const Moves& moves, const std::string& name, Place place) {
  const auto there = what_is_at(moves.to(name));
  if (!there) return fail(there.error());
  if (!*there) return {};
  if (S_ISDIR((*there)->st_mode)) {
    errno = EISDIR;
    return cannot_move(moves.to(name), "cannot write");
  }
  const std::string to = moves.to(name), aside = moves.aside(name);
  if (place == Place::stays_filled && ::link(to.c_str(), aside.c_str()) == 0) return {};
  if (::rename(to.c_str(), aside.c_str()) == 0) return {};
  return cannot_move(to, "cannot keep the older file");
}

Expected<void> move_all(const Moves& moves) {
  const std::string& last = moves.files.back().name;
  if (auto kept = keep_aside(moves, last, Place::is_emptied); !kept) return kept;
  for (const std::string& name : moves.new_folders)
    if (auto made = make_folder(moves.to(name)); !made) return made;
  for (const MovingFile& file : moves.files) {
    if (file.name != last)
      if (auto kept = keep_aside(moves, file.name, Place::stays_filled); !kept) return kept;
    if (auto moved = rename_file(moves.from(file.name), moves.to(file.name)); !moved) return moved;
  }
  return {};
}

/// Memory that is missing is an error like others here: what has moved has to go back.
Expected<void> move_all_or_tell(const Moves& moves) {
  try {
    return move_all(moves);
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::graphics, "out of memory");
  }
}

/// Whether it has left the staged folder and stands in its place.
Expected<bool> is_in_place(const Moves& moves, const MovingFile& file) {
  const auto before = what_is_at(moves.from(file.name));
  if (!before) return fail(before.error());
  if (*before) return false;
  const auto now = what_is_at(moves.to(file.name));
  if (!now) return fail(now.error());
  return *now && (*now)->st_ino == file.inode && modified_ns(**now) == file.modified_ns;
}

/// The file goes back before the older one does, so that each state tells how far it came.
Expected<void> undo_move(const Moves& moves, const MovingFile& file) {
  const auto moved = is_in_place(moves, file);
  if (!moved) return fail(moved.error());
  if (*moved)
    if (auto back = rename_file(moves.to(file.name), moves.from(file.name)); !back) return back;
  const auto older = what_is_at(moves.aside(file.name)), there = what_is_at(moves.to(file.name));
  if (!older) return fail(older.error());
  if (!there) return fail(there.error());
  if (*older && !*there) return rename_file(moves.aside(file.name), moves.to(file.name));
  return {};
}

/// All that can be undone is; the error is that of the first step that cannot.
Expected<void> undo_all(const Moves& moves) {
  Expected<void> whole;
  for (const MovingFile& file : moves.files)  // the one that shows a whole folder comes back last
    if (auto undone = undo_move(moves, file); !undone && whole) whole = undone;
  for (auto name = moves.new_folders.rbegin(); name != moves.new_folders.rend(); ++name)
    ::rmdir(moves.to(*name).c_str());  // stays where somebody else has put something into it
  return whole;
}

}  // namespace

Expected<void> publish_into(const std::string& folder, const std::string& staged,
                            std::span<const std::string> files, const std::string& last) {
  if (auto made = make_folder(fmt::format("{}/{}", staged, replaced_name)); !made) return made;
  const auto moves = plan_moves(folder, staged, files, last);
  if (!moves) return fail(moves.error());
  if (moves->files.empty()) return {};
  if (auto listed = write_file(moves->list(), list_text(*moves)); !listed) return listed;
  auto moved = move_all_or_tell(*moves);
  if (moved) return {};
  if (const auto undone = undo_all(*moves))
    (void)remove_path(moves->list());  // where it stays, the next run finds that nothing is left to undo
  else
    moved.error().reason += fmt::format(
        "; older files could not be put back either ({}) and lie in {}/{}, until the next run "
        "into this folder puts them back",
        undone.error().message(), staged, replaced_name);
  return moved;
}

bool is_unfinished_publication(const std::string& staged) {
  return is_there(fmt::format("{}/{}", staged, list_name)).value_or(true);
}

Expected<void> undo_publication(const std::string& folder, const std::string& staged) {
  const auto moves = read_list(folder, staged);
  if (!moves) return fail(moves.error());
  if (moves->files.empty()) return remove_path(moves->list());
  const auto complete = is_in_place(*moves, moves->files.back());  // killed after its last step
  if (!complete) return fail(complete.error());
  if (!*complete)
    if (auto undone = undo_all(*moves); !undone) return undone;
  return remove_path(moves->list());
}

}  // namespace gnomon
