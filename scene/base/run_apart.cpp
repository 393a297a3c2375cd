#include "scene/base/run_apart.h"

#include <fmt/core.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "scene/base/confine.h"
#include "scene/base/run_program.h"
#include "scene/files/path_status.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> no_file(const char* what) {
  return fail(ErrorKind::graphics, fmt::format("cannot make {}: {}", what, std::strerror(errno)));
}

/// A file in memory.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : number_(memfd_create(name, MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (is_open()) ::close(number_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  bool is_open() const { return number_ >= 0; }
  int number() const { return number_; }
  /// Whoever has inherited the descriptor opens the file again by this path.
  std::string path() const { return fmt::format("/proc/self/fd/{}", number_); }

  bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(number_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  /// The file's beginning.
  Expected<std::string> bytes(std::size_t most) const {
    struct stat status {};
    if (::fstat(number_, &status) != 0) return no_file("a file in memory");
    std::string bytes(std::min(most, static_cast<std::size_t>(status.st_size)), '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count =
          ::pread(number_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return no_file("a file in memory");
      if (count == 0) break;
      done += static_cast<std::size_t>(count);
    }
    bytes.resize(done);
    return bytes;
  }

 private:
  int number_;
};

/// A folder of which nothing is known, and which goes with what is in it.
class FolderOfOne {
 public:
  FolderOfOne() {
    std::error_code error;
    path_ = (fs::temp_directory_path(error) / "gnomon-model-XXXXXX").string();
    if (error || ::mkdtemp(path_.data()) == nullptr) path_.clear();
  }
  ~FolderOfOne() {
    if (!path_.empty()) (void)remove_all_of(path_);  // who is left to be told?
  }
  FolderOfOne(const FolderOfOne&) = delete;
  FolderOfOne& operator=(const FolderOfOne&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The program as the PATH has it, and the libraries that came with it where it does not lie where the system's programs do.
void add_places(const std::string& program, std::vector<std::string>& places) {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    std::error_code none;
    const fs::path file = fs::canonical(fs::path(folder) / program, none);
    if (none || ::access(file.c_str(), X_OK) != 0) continue;
    places.push_back(file.string());
    places.push_back((file.parent_path().parent_path() / "lib").string());
    return;
  }
}

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace

Expected<ApartEnd> run_apart(const ApartProgram& program) {
  constexpr std::size_t longest_said = 1 << 20;
  const WaitedFor until_the_folder_is_gone;
  const MemoryFile in("gnomon-in"), out("gnomon-out"), said("gnomon-said");
  if (!in.is_open() || !out.is_open() || !said.is_open() || !in.write(program.bytes))
    return no_file("a file in memory");
  const FolderOfOne folder;
  const std::string link = folder.path() + "/" + program.name;
  if (folder.path().empty() || ::symlink(in.path().c_str(), link.c_str()) != 0)
    return no_file("a temporary folder");
  std::vector<std::string> places;
  for (const std::string& each : program.programs) add_places(each, places);
  const auto code = run_program(program.words(link, out.path()), program.longest_s, said.number(),
                                {{in.number(), out.number()}, [&places] { give_up_rights(places); }});
  if (!code) return fail(code.error());
  auto words = said.bytes(longest_said), written = out.bytes(std::string::npos);
  if (!words) return fail(words.error());
  if (!written) return fail(written.error());
  replace_all(*words, link, program.name);
  return ApartEnd{*code, std::move(*words), std::move(*written)};
}

}  // namespace gnomon
