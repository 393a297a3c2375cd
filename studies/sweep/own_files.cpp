#include "studies/sweep/own_files.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "scene/base/interrupted.h"
#include "scene/files/path_status.h"
#include "scene/files/write_file.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/sweep_line.h"

namespace gnomon::studies {
namespace {

struct Opening {
  std::string_view name, text;
};
constexpr Opening openings[] = {{"sweep.jsonl", R"({"schema":"gnomon/result/1",)"},
                                {"sweep_times.jsonl", R"({"cell":)"},
                                {"sweep.csv", "cell,"},
                                {"ray_tracer.json", "{\n \"schema\": \"gnomon/rays/1\","}};
// After what every page begins with, which tells none from another.
constexpr std::string_view page_title = "<title>Sweep of ";
constexpr std::size_t longest_head = 4096;  // bytes before the end of a page's title

Expected<void> check_link(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return {};
    return failed_call(ErrorKind::cannot_write, path, "cannot be looked at", errno);
  }
  return S_ISLNK(status.st_mode) ? not_a_sweeps(path, "is a link") : Expected<void>{};
}

}  // namespace

tl::unexpected<Error> not_a_sweeps(const std::string& path, std::string_view what) {
  return fail(Error{
      ErrorKind::cannot_write,
      fmt::format("{}, which no sweep has written; it is left as it is: give another folder (-o)", what),
      path});
}

bool begins_as_own(std::string_view name, std::string_view text) {
  if (name == "report.html") return text.substr(0, longest_head).find(page_title) != std::string_view::npos;
  const auto* const own = std::ranges::find(openings, name, &Opening::name);
  return own != std::end(openings) && (text.starts_with(own->text) || own->text.starts_with(text));
}

Expected<OwnFile> OwnFile::open(const std::string& folder, std::string_view name, bool make) {
  OwnFile file;
  file.path_ = path_in(folder, name), file.name_ = name;
  // O_NONBLOCK: a pipe with no other end would not open.
  const int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | (make ? O_CREAT : 0);
  file.descriptor_ = uninterrupted([&] { return ::open(file.path_.c_str(), flags, 0666); });
  if (!file.is_open()) {
    if (!make && (errno == ENOENT || errno == ENOTDIR)) return file;
    if (errno == ELOOP) return not_a_sweeps(file.path_, "is a link");
    return failed_call(ErrorKind::cannot_write, file.path_, "cannot be opened", errno);
  }
  struct stat status {};
  if (::fstat(file.descriptor_, &status) != 0)
    return failed_call(ErrorKind::cannot_write, file.path_, "cannot be looked at", errno);
  if (!S_ISREG(status.st_mode)) return not_a_sweeps(file.path_, "is no plain file");
  if (status.st_nlink == 1) return file;
  const auto text = file.text();
  if (!text) return fail(text.error());
  if (auto copied = write_file_in(folder, std::string(name), *text); !copied) return fail(copied.error());
  return open(folder, name, make);
}

OwnFile::~OwnFile() {
  if (is_open()) ::close(descriptor_);
}

Expected<std::string> text_of_open(int descriptor, const std::string& path, ErrorKind error) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return failed_call(error, path, "cannot be looked at", errno);
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count =
        ::pread(descriptor, text.data() + done, text.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return failed_call(error, path, "cannot be read", count < 0 ? errno : EIO);
    done += static_cast<std::size_t>(count);
  }
  return text;
}

Expected<std::string> OwnFile::text() const {
  if (!is_open()) return std::string();
  auto text = text_of_open(descriptor_, path_, ErrorKind::cannot_write);
  if (text && !begins_as_own(name_, *text)) return not_a_sweeps(path_, "holds something else");
  return text;
}

namespace {

Expected<void> check_links(const std::string& folder, const std::vector<std::string>& pictures) {
  for (const std::string_view name : sweep_file_names)
    if (auto plain = check_link(path_in(folder, name)); !plain) return plain;
  for (const std::string& picture : pictures)
    if (auto plain = check_link(picture); !plain) return plain;
  return {};
}

}  // namespace

Expected<std::optional<std::size_t>> cells_of_sweep(const std::string& folder) {
  const std::string path = path_in(folder, "sweep.json");
  const auto there = is_there(path, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (!*there) return std::optional<std::size_t>();
  const auto text = read_as(ErrorKind::cannot_write, path);
  if (!text) return fail(text.error());
  const auto cells = cells_of_header(*text);
  if (!cells) return not_a_sweeps(path, "is no sweep's configuration");
  return cells;
}

Expected<void> check_own_files(const std::string& folder, bool has_sweep) {
  for (const std::string_view name : sweep_folder_names)
    if (auto plain = check_link(path_in(folder, name)); !plain) return plain;
  const auto pictures = cell_pictures_in(folder);
  if (!pictures) return fail(pictures.error());
  if (auto plain = check_links(folder, *pictures); !plain) return plain;
  constexpr std::string_view unlisted = "lies here without a sweep's own list";
  for (const std::string_view name : {"sweep.jsonl", "sweep_times.jsonl", "sweep.csv"}) {
    const auto file = OwnFile::open(folder, name, false);
    if (!file) return fail(file.error());
    const auto text = file->text();
    if (!text) return fail(text.error());
    const std::string_view first = std::string_view(*text).substr(0, text->find('\n') + 1);
    if (name == "sweep.jsonl") has_sweep = has_sweep || is_sealed(first);
    if (!has_sweep && !text->empty()) return not_a_sweeps(file->path(), unlisted);
  }
  if (!has_sweep && !pictures->empty()) return not_a_sweeps(pictures->front(), unlisted);
  return {};
}

}  // namespace gnomon::studies
