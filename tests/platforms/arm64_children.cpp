// Loaded (LD_PRELOAD) into programs for 64-bit ARM that run under qemu where the kernel does not know how to start another (binfmt_misc,
// which needs root): whatever they start is started by qemu again, and programs of this machine as they are. EMULATOR and ROOT are
// qemu's path and Debian's libraries for arm64 (arm64.sh).
#include <dlfcn.h>
#include <elf.h>
#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <cstring>

extern char** environ;  // NOLINT(readability-redundant-declaration): unistd.h has it for some

namespace {

constexpr int most_words = 4096;

bool is_for_arm(const char* path) {
  Elf64_Ehdr header{};
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const ssize_t count = read(file, &header, sizeof header);
  close(file);
  return count == sizeof header && std::memcmp(header.e_ident, ELFMAG, SELFMAG) == 0 &&
         header.e_machine == EM_AARCH64;
}

/// What the kernel is asked to start instead. Between fork and exec: nothing is allocated.
class Start {
 public:
  Start(const char* path, char* const* words, char* const* environment) {
    if (std::strcmp(path, "/proc/self/exe") == 0)
      if (const ssize_t length = readlink(path, self_.data(), self_.size() - 1); length > 0)
        path = self_.data();
    const bool by_qemu = is_for_arm(path);
    path_ = by_qemu ? EMULATOR : path;
    int count = 0;
    if (by_qemu)
      for (const char* word : std::array<const char*, 6>{EMULATOR, "-L", ROOT, "-0", words[0], path})
        words_[count++] = word;
    for (int i = by_qemu ? 1 : 0; words[i] != nullptr && count < most_words; ++i) words_[count++] = words[i];
    words_[count] = nullptr;
    count = 0;
    for (int i = 0; environment[i] != nullptr && count < most_words; ++i)
      if (by_qemu || std::strncmp(environment[i], "LD_PRELOAD=", 11) != 0)
        environment_[count++] = environment[i];
    environment_[count] = nullptr;
  }
  const char* path() const { return path_; }
  char* const* words() const { return const_cast<char* const*>(words_.data()); }
  char* const* environment() const { return environment_.data(); }

 private:
  const char* path_;
  std::array<char, PATH_MAX> self_{};
  std::array<const char*, most_words + 1> words_;
  std::array<char*, most_words + 1> environment_;
};

template <class Function>
Function* next(const char* name, Function*) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// Looked up before anything is forked.
const auto real_execve = next("execve", &execve);
const auto real_posix_spawnp = next("posix_spawnp", &posix_spawnp);

}  // namespace

extern "C" {

int execve(const char* path, char* const words[], char* const environment[]) {
  const Start start(path, words, environment);
  return real_execve(start.path(), start.words(), start.environment());
}
int execv(const char* path, char* const words[]) {
  return execve(path, words, environ);
}
int posix_spawnp(pid_t* child, const char* path, const posix_spawn_file_actions_t* actions,
                 const posix_spawnattr_t* attributes, char* const words[], char* const environment[]) {
  const Start start(path, words, environment);
  return real_posix_spawnp(child, start.path(), actions, attributes, start.words(), start.environment());
}

}  // extern "C"
