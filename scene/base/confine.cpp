// Landlock: Documentation/userspace-api/landlock.rst of the kernel. Its rights grow with its version, which the system tells.
#include "scene/base/confine.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace gnomon {
namespace {

// Where programs, their libraries and the data of libraries are.
constexpr const char* system_places[] = {"/usr",
                                         "/lib",
                                         "/lib32",
                                         "/lib64",
                                         "/libx32",
                                         "/bin",
                                         "/opt",
                                         "/nix/store",
                                         "/gnu/store",
                                         "/etc/ld.so.cache",
                                         "/etc/ld.so.preload",
                                         "/etc/alternatives",
                                         "/dev/null"};

/// struct landlock_ruleset_attr as of version 6; older kernels take its beginning.
struct Ruleset {
  std::uint64_t files = 0, network = 0, scoped = 0;
};

constexpr std::uint64_t bits(int count) {
  return (std::uint64_t{1} << count) - 1;
}

/// All rights that this version of Landlock can take away, and the size of what it reads.
Ruleset all_rights(long version, std::size_t& size) {
  constexpr std::size_t word = sizeof(std::uint64_t);
  size = version >= 6 ? 3 * word : version >= 4 ? 2 * word : word;
  return {.files = bits(version >= 5   ? 16
                        : version >= 3 ? 15
                        : version >= 2 ? 14
                                       : 13),
          .network = version >= 4 ? bits(2) : 0,
          .scoped = version >= 6 ? bits(2) : 0};
}

/// Lets the path be read and run, and of a folder all below it; one that is not there needs no rule.
void allow(int ruleset, const char* path) {
  const int place = ::open(path, O_PATH | O_CLOEXEC);
  if (place < 0) return;
  struct stat status {};
  landlock_path_beneath_attr rule{};
  rule.parent_fd = place;
  rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_EXECUTE;
  if (::fstat(place, &status) == 0 && S_ISDIR(status.st_mode))
    rule.allowed_access |= LANDLOCK_ACCESS_FS_READ_DIR;
  ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  ::close(place);
}

bool give_up_files(const std::vector<std::string>& readable) {
  const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return false;
  std::size_t size = 0;
  const Ruleset rights = all_rights(version, size);
  const int ruleset = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &rights, size, 0));
  if (ruleset < 0) return false;
  for (const char* place : system_places) allow(ruleset, place);
  for (const std::string& place : readable) allow(ruleset, place.c_str());
  const bool done = ::syscall(SYS_landlock_restrict_self, ruleset, 0) == 0;
  ::close(ruleset);
  return done;
}

constexpr sock_filter load(std::size_t offset) {
  return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}
constexpr sock_filter end_with(std::uint32_t what) {
  return BPF_STMT(BPF_RET | BPF_K, what);
}

/// Landlock knows TCP alone. No sockets of any kind, nor what could make them otherwise; calls of another machine's numbers
/// (32 bits on 64) end the process.
void give_up_sockets() {
  constexpr std::uint32_t first_of_x32 = 0x40000000;
  constexpr bool is_wide = sizeof(void*) == 8;
  sock_filter filter[] = {
      load(offsetof(seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, is_wide ? __AUDIT_ARCH_64BIT : ~0u, 1, 0),
      end_with(SECCOMP_RET_KILL_PROCESS),
      load(offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, first_of_x32, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_socket, 1, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_io_uring_setup, 0, 1),
      end_with(SECCOMP_RET_ERRNO | EACCES),
      end_with(SECCOMP_RET_ALLOW),
  };
  const sock_fprog program{static_cast<unsigned short>(std::size(filter)), filter};
  ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

}  // namespace

bool give_up_rights(const std::vector<std::string>& readable) {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  const bool done = give_up_files(readable);
  give_up_sockets();
  return done;
}

}  // namespace gnomon
