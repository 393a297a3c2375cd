#include "scene/files/publication.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>

#include "scene/files/path_status.h"

namespace gnomon {
namespace {

Expected<void> rename_from(const Folder& from, const Folder& to, const std::string& name, const char* step) {
  if (::renameat(from.descriptor(), name.c_str(), to.descriptor(), name.c_str()) == 0) return {};
  return failed_call(ErrorKind::cannot_write, to.path_of(name), step, errno);
}

/// "a" and "a/b" of "a/b/c".
void add_folders_of(const std::string& name, std::set<std::string>& folders) {
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 1))
    folders.insert(name.substr(0, at));
}

}  // namespace

Expected<Publication> Publication::plan(const Folder& folder, const Folder& staged,
                                        std::span<const std::string> files, const std::string& last) {
  if (auto made = make_folder_in(staged, replaced_name); !made) return fail(made.error());
  auto aside = staged.below(replaced_name);
  if (!aside) return fail(aside.error());
  Publication plan(folder, staged, std::move(*aside));
  if (auto added = plan.add(files, last); !added) return fail(added.error());
  return plan;
}

Expected<void> Publication::add(std::span<const std::string> files, const std::string& last) {
  std::set<std::string> folders;
  for (const std::string& name : files) {
    add_folders_of(name, folders);
    files_.push_back({name});
  }
  std::stable_partition(files_.begin(), files_.end(), [&](const File& file) { return file.name != last; });
  has_last_ = !files_.empty() && files_.back().name == last;
  return look_at_folders({folders.begin(), folders.end()});
}

/// A link in the way is found here, before anything moves.
Expected<void> Publication::look_at_folders(const std::vector<std::string>& folders) {
  for (const std::string& name : folders) {
    if (auto made = make_folder_in(aside_, name); !made) return fail(made.error());
    const std::string above = folder_part(name);
    if (std::ranges::count(new_folders_, above) > 0) {
      new_folders_.push_back(name);
      continue;
    }
    const auto around = folder_->below(above);
    if (!around) return fail(around.error());
    const auto there = around->find(last_part(name));
    if (!there) return fail(there.error());
    if (!*there)
      new_folders_.push_back(name);
    else if (auto folder = around->below(last_part(name)); !folder)
      return fail(folder.error());
  }
  return {};
}

Expected<Publication::Places*> Publication::places_of(const std::string& name) {
  const std::string part = folder_part(name);
  if (places_ && open_ == part) return &*places_;
  auto to = folder_->below(part), from = staged_->below(part), aside = aside_.below(part);
  for (auto* opened : {&to, &from, &aside})
    if (!*opened) return fail(opened->error());
  places_ = Places{std::move(*to), std::move(*from), std::move(*aside)};
  open_ = part;
  return &*places_;
}

/// Gives the older file a second name where that will do and the file system has such, so that the first is never without
/// its file.
Expected<void> Publication::keep_aside(File& file, bool may_stay) {
  const auto places = places_of(file.name);
  if (!places) return fail(places.error());
  const auto& [to, from, aside] = **places;
  const std::string name = last_part(file.name);
  const auto there = to.find(name);
  if (!there) return fail(there.error());
  if (!*there) return {};
  if (S_ISDIR((*there)->st_mode))
    return failed_call(ErrorKind::cannot_write, to.path_of(name), "cannot write", EISDIR);
  if (!may_stay || ::linkat(to.descriptor(), name.c_str(), aside.descriptor(), name.c_str(), 0) != 0)
    if (auto moved = rename_from(to, aside, name, "cannot keep the older file"); !moved) return moved;
  file.kept = true;
  return {};
}

Expected<void> Publication::move(File& file) {
  const auto places = places_of(file.name);
  if (!places) return fail(places.error());
  const auto& [to, from, aside] = **places;
  const std::string name = last_part(file.name);
  const auto there = from.find(name);
  if (!there) return fail(there.error());
  if (!*there) return fail(Error{ErrorKind::cannot_write, "a finished file is gone", from.path_of(name)});
  file.inode = (*there)->st_ino;
  if (auto moved = rename_from(from, to, name, "cannot rename the finished file"); !moved) return moved;
  file.moved = true;
  return {};
}

Expected<void> Publication::begin() {
  // In a folder that is yet to be made there is none to be taken away.
  if (has_last_ && std::ranges::count(new_folders_, folder_part(files_.back().name)) == 0)
    if (auto kept = keep_aside(files_.back(), false); !kept) return kept;
  for (const std::string& name : new_folders_) {
    const auto made = make_folder_in(*folder_, name);
    if (!made) return fail(made.error());
    if (*made) made_folders_.push_back(name);
  }
  for (std::size_t i = 0; i + (has_last_ ? 1 : 0) < files_.size(); ++i) {
    if (auto kept = keep_aside(files_[i], true); !kept) return kept;
    if (auto moved = move(files_[i]); !moved) return moved;
  }
  return {};
}

Expected<void> Publication::finish() {
  return has_last_ ? move(files_.back()) : Expected<void>{};
}

void Publication::drop_older() {
  for (File& file : files_) {
    if (!file.kept) continue;
    if (const auto places = places_of(file.name))
      file.kept = ::unlinkat((*places)->aside.descriptor(), last_part(file.name).c_str(), 0) != 0;
  }
}

/// A file that somebody else has put in the place of one of ours stays.
Expected<void> Publication::undo(File& file) {
  if (!file.kept && !file.moved) return {};
  const auto places = places_of(file.name);
  if (!places) return fail(places.error());
  const auto& [to, from, aside] = **places;
  const std::string name = last_part(file.name);
  const auto there = to.find(name);
  if (!there) return fail(there.error());
  const bool is_ours = *there && file.moved && (*there)->st_ino == file.inode;
  Expected<void> back;
  if (file.kept && (is_ours || !*there))
    back = rename_from(aside, to, name, "cannot put the older file back");
  else if (is_ours)
    back = rename_from(to, from, name, "cannot take the new file back");
  if (back) file.kept = file.moved = false;
  return back;
}

Expected<void> Publication::undo() {
  Expected<void> whole;
  for (File& file : files_)  // the one that shows a whole folder comes back last
    if (auto undone = undo(file); !undone && whole) whole = undone;
  for (auto name = made_folders_.rbegin(); name != made_folders_.rend(); ++name)
    if (const auto around =
            folder_->below(folder_part(*name)))  // stays where somebody else has put something into it
      ::unlinkat(around->descriptor(), last_part(*name).c_str(), AT_REMOVEDIR);
  return whole;
}

}  // namespace gnomon
