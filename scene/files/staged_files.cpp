#include "scene/files/staged_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "scene/files/path_status.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

/// With links resolved as far as there is something.
Expected<std::string> whole_path(const std::string& folder) {
  std::error_code error;
  const fs::path absolute = fs::absolute(folder.empty() ? "." : folder, error);
  const fs::path whole = error ? fs::path() : fs::weakly_canonical(absolute, error);
  if (error) return failed_call(ErrorKind::cannot_write, folder, "cannot be looked at", error.value());
  return whole.has_filename() ? whole.string() : whole.parent_path().string();
}

}  // namespace

StagedFiles::~StagedFiles() {
  places_.clear();
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) ::rmdir(folder->c_str());
}

Expected<const StagedFolder*> StagedFiles::staged_for(const std::string& folder) {
  for (const Place& place : places_)
    if (place.folder == folder) return &place.staged;
  if (auto made = make_output_folder(folder, &made_); !made) return fail(made.error());
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  places_.push_back({folder, std::move(*staged)});
  return &places_.back().staged;
}

Expected<std::string> StagedFiles::place_of(const std::string& path, const StagedFolder* folder) {
  const auto target = follow_link(path);
  if (!target) return fail(target.error());
  struct stat older = {};
  const bool there = ::stat(target->c_str(), &older) == 0;
  if (there && !S_ISREG(older.st_mode)) return path;
  const auto around = whole_path(fs::path(*target).parent_path().string());
  if (!around) return fail(around.error());
  bool inside = false;
  if (folder != nullptr) {
    const auto own = whole_path(folder->folder());
    if (!own) return fail(own.error());
    inside = *own == *around;
  }
  const auto staged = inside ? Expected<const StagedFolder*>(folder) : staged_for(*around);
  if (!staged) return fail(staged.error());
  const auto named = [&](const std::string& name) {
    return (*staged)->path() + "/" + fs::path(name).filename().string();
  };
  finishes_.push_back({named(path), named(*target), std::nullopt});
  if (there) finishes_.back().permissions = older.st_mode & 07777;
  return finishes_.back().staged;
}

Expected<void> StagedFiles::write(const FileText& file, const StagedFolder* folder) {
  if (file.path.empty()) return {};
  const auto place = place_of(file.path, folder);
  if (!place) return fail(place.error());
  if (*place != file.path) return write_file(*place, file.bytes);
  direct_.push_back(file);
  return {};
}

Expected<void> StagedFiles::seal() {
  for (const Finish& file : finishes_) {
    if (file.permissions && ::chmod(file.staged.c_str(), *file.permissions) != 0)
      return failed_call(ErrorKind::cannot_write, file.named, "cannot keep its permissions", errno);
    if (file.staged != file.named && ::rename(file.staged.c_str(), file.named.c_str()) != 0)
      return failed_call(ErrorKind::cannot_write, file.named, "cannot rename the finished file", errno);
  }
  for (Place& place : places_)
    if (auto sealed = place.staged.seal({}); !sealed) return sealed;
  return {};
}

std::string StagedFiles::sealed_place(const std::string& place) const {
  for (const Finish& file : finishes_)
    if (file.staged == place) return file.named;
  return place;
}

Expected<void> StagedFiles::publish(StagedFolder* folder, const std::string& last) {
  std::vector<StagedFolder::Part> parts;
  for (Place& place : places_) parts.push_back({&place.staged, {}});
  if (folder != nullptr) parts.push_back({folder, last});
  if (auto moved = StagedFolder::publish(parts); !moved) return moved;
  made_.clear();
  for (const FileText& file : direct_)
    if (auto written = write_file(file.path, file.bytes); !written) return written;
  return {};
}

Expected<void> StagedFiles::publish(StagedFolder& folder, const std::string& last,
                                    std::span<const std::string> inputs, std::span<const FileText> texts) {
  for (const FileText& text : texts)
    if (auto written = write(text, &folder); !written) return written;
  if (auto sealed = seal(); !sealed) return sealed;
  if (auto sealed = folder.seal(inputs); !sealed) return sealed;
  return publish(&folder, last);
}

}  // namespace gnomon
