// Loaded before a program (LD_PRELOAD): makes one chosen call of the C library fail, to see what the program does then.
// tests/faults/campaign.py drives it over every command. What is asked for stands in the environment:
//
//   GNOMON_FAULT_CALL       which kind of call (`names` below); none: nothing fails, calls are counted
//   GNOMON_FAULT_AT=N       the N-th of them fails, from 1; with GNOMON_FAULT_ONWARD=1 all from then on do
//   GNOMON_FAULT_ERROR      what errno says then, a number; default EIO
//   GNOMON_FAULT_WORKERS=1  calls of the main thread are not counted
//   GNOMON_FAULT_FOLDERS    A:B: calls about files are counted for what lies in these folders; default everywhere
//   GNOMON_FAULT_NOT_FROM   A:B: calls made by libraries with such a part in their path are not counted
//   GNOMON_FAULT_PROGRAM    the path of the program meant; processes of others are left alone; default all
//   GNOMON_FAULT_PROCESS=K  the K-th process of that program alone, from 0; default all
//   GNOMON_FAULT_ACCOUNT    FILE takes the counts, and FILE.calls a line for each counted call about a file, with its path
//                           and the allocations before it, and for the failing one, with its path and its callers
//
// Callers are judged by the innermost frames up to the program's own: what a driver or a library asks for on the program's
// behalf is that library's call. What a library does while the loader starts it (a static constructor) is not counted
// either: it cannot report a failure. Counts are shared between a process and what it forks.
#include "tests/faults/injector.h"

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <unwind.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace gnomon::faults {
namespace {

constexpr const char* names[kinds] = {
    "write",      "short-write", "fsync",    "close",        "rename",     "link",    "open",
    "mkdir",      "unlink",      "truncate", "read",         "short-read", "list",    "stat",
    "descriptor", "mmap",        "malloc",   "large-malloc", "thread",     "process", "pipe"};

constexpr int most_processes = 4096;
struct Account {
  std::atomic<long> processes;
  std::atomic<long> counts[most_processes][kinds];
};

struct Plan {
  int kind = -1, error = EIO;
  long at = 0, process = -1;
  bool onward = false, workers = false, counting = false, ready = false;
  const char *folders = nullptr, *not_from = nullptr;
  char calls[1024] = "";
};

Plan plan;
Account own_account;
Account* account = &own_account;
long own_process = 0;
std::atomic<bool> done{false};
thread_local bool inside __attribute__((tls_model("initial-exec"))) = false;

/// The next part of "A:B:C" from `list` on, which then is what follows.
std::size_t next_part(const char*& list, const char*& part) {
  part = list;
  const std::size_t length = std::strcspn(list, ":");
  list += length + (list[length] == ':');
  return length;
}

enum class From : std::uintptr_t { elsewhere, program, excepted, loader, runtime };

From judge_name(const char* name) {
  if (name[0] == '\0' || std::strstr(name, "libgnomon") != nullptr) return From::program;
  if (std::strstr(name, "/ld-linux") != nullptr) return From::loader;
  for (const char* known : {"/libc.so", "/libstdc++.so", "/libgcc_s.so", "/libm.so", "fault_injector"})
    if (std::strstr(name, known) != nullptr) return From::runtime;
  const char* part = nullptr;
  for (const char* list = plan.not_from; list != nullptr && *list != '\0';) {
    char text[256];
    const std::size_t length = std::min(next_part(list, part), sizeof text - 1);
    std::memcpy(text, part, length);
    text[length] = '\0';
    if (std::strstr(name, text) != nullptr) return From::excepted;
  }
  return From::elsewhere;
}

/// What holds this address. A module's answer is kept, in the low bits of its (page's) address.
From from_of(const void* address) {
  static std::atomic<std::uintptr_t> kept[256];
  dl_find_object found;
  if (_dl_find_object(const_cast<void*>(address), &found) != 0) return From::elsewhere;
  const auto start = reinterpret_cast<std::uintptr_t>(found.dlfo_map_start);
  std::atomic<std::uintptr_t>& slot = kept[(start >> 12U) % 256];
  if (const std::uintptr_t known = slot; (known & ~std::uintptr_t{0xfff}) == start && (known & 0x100U) != 0)
    return static_cast<From>(known & 0xffU);
  const From from = judge_name(found.dlfo_link_map->l_name);
  slot = start | 0x100U | static_cast<std::uintptr_t>(from);
  return from;
}

struct Stack {
  static constexpr int most = 64;
  const void* frames[most];
  int count = 0;
};

_Unwind_Reason_Code add_frame(_Unwind_Context* context, void* stack) {
  Stack& into = *static_cast<Stack*>(stack);
  if (into.count == Stack::most) return _URC_END_OF_STACK;
  into.frames[into.count++] = reinterpret_cast<const void*>(_Unwind_GetIP(context) - 1);
  return _URC_NO_REASON;
}

/// Whether the program can answer for the call: neither a library that is excepted nor a static constructor made it.
bool is_the_programs(const Stack& stack) {
  bool of_a_library = false;
  for (int i = 0; i < stack.count; ++i) switch (from_of(stack.frames[i])) {
      case From::program:
        return true;
      case From::excepted:
        return false;
      case From::loader:
        if (of_a_library) return false;
        break;
      case From::elsewhere:
        of_a_library = true;
        break;
      case From::runtime:
        break;
    }
  return true;
}

/// A line for FILE.calls. Of a call that is counted it says last how many allocations were made before.
void tell(const char* what, int kind, long n, const char* path, const Stack* stack) {
  if (plan.calls[0] == '\0') return;
  char line[4096];
  int length = std::snprintf(line, sizeof line, "%s %ld %s %ld %s", what, own_process, names[kind], n,
                             path == nullptr || path[0] == '\0' ? "-" : path);
  for (int i = 0; stack != nullptr && i < stack->count && length < 3800; ++i) {
    dl_find_object found;
    if (_dl_find_object(const_cast<void*>(stack->frames[i]), &found) != 0) continue;
    const char* name = found.dlfo_link_map->l_name;
    const char* last = std::strrchr(name, '/');
    length +=
        std::snprintf(line + length, sizeof line - static_cast<std::size_t>(length), "%s%.60s+%#lx",
                      i == 0 ? "\t" : " ", name[0] == '\0' ? "gnomon" : (last == nullptr ? name : last + 1),
                      static_cast<unsigned long>(static_cast<const char*>(stack->frames[i]) -
                                                 reinterpret_cast<const char*>(found.dlfo_link_map->l_addr)));
  }
  if (stack == nullptr)
    length += std::snprintf(line + length, sizeof line - static_cast<std::size_t>(length), "\t%ld",
                            account->counts[own_process][malloc_].load());
  line[length++] = '\n';
  const long file =
      syscall(SYS_openat, AT_FDCWD, plan.calls, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) return;
  syscall(SYS_write, file, line, length);
  syscall(SYS_close, file);
}

bool lies_in_folders(const char* path) {
  if (plan.folders == nullptr) return true;
  const char* part = nullptr;
  for (const char* list = plan.folders; *list != '\0';) {
    const std::size_t length = next_part(list, part);
    if (length > 0 && std::strncmp(path, part, length) == 0 && (path[length] == '/' || path[length] == '\0'))
      return true;
  }
  return false;
}

long number_from(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atol(text);
}

void open_account(const char* path) {
  const long file = syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return;
  syscall(SYS_ftruncate, file, sizeof(Account));
  const long place = syscall(SYS_mmap, 0L, sizeof(Account), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0L);
  if (place > 0) account = reinterpret_cast<Account*>(place);
  syscall(SYS_close, file);
  std::snprintf(plan.calls, sizeof plan.calls, "%s.calls", path);
}

__attribute__((constructor(101))) void begin() {
  if (const char* program = std::getenv("GNOMON_FAULT_PROGRAM")) {
    char own[4096];
    const long length = syscall(SYS_readlink, "/proc/self/exe", own, sizeof own - 1);
    own[std::max(length, 0L)] = '\0';
    if (std::strcmp(own, program) != 0) return;
  }
  const char* call = std::getenv("GNOMON_FAULT_CALL");
  for (int kind = 0; call != nullptr && kind < kinds; ++kind)
    if (std::strcmp(call, names[kind]) == 0) plan.kind = kind;
  plan.counting = call == nullptr;
  plan.at = number_from("GNOMON_FAULT_AT", 0);
  plan.error = static_cast<int>(number_from("GNOMON_FAULT_ERROR", EIO));
  plan.process = number_from("GNOMON_FAULT_PROCESS", -1);
  plan.onward = number_from("GNOMON_FAULT_ONWARD", 0) != 0;
  plan.workers = number_from("GNOMON_FAULT_WORKERS", 0) != 0;
  plan.folders = std::getenv("GNOMON_FAULT_FOLDERS");
  plan.not_from = std::getenv("GNOMON_FAULT_NOT_FROM");
  if (const char* path = std::getenv("GNOMON_FAULT_ACCOUNT")) open_account(path);
  own_process = account->processes++ % most_processes;
  plan.ready = plan.process < 0 || plan.process == own_process;
}

/// Counts this call, and says whether it is to fail.
bool count(int kind, const char* path, const void* caller) {
  if (from_of(caller) == From::excepted) return false;
  if (plan.workers && syscall(SYS_gettid) == syscall(SYS_getpid)) return false;
  const long n = ++account->counts[own_process][kind];
  if (plan.counting) {
    if (path != nullptr) tell("call", kind, n, path, nullptr);
    return false;
  }
  if (n < plan.at || (done && !plan.onward)) return false;
  Stack stack;
  _Unwind_Backtrace(add_frame, &stack);
  if (!is_the_programs(stack)) return false;
  if (!plan.onward && done.exchange(true)) return false;
  if (!plan.onward || !done.exchange(true)) tell("failed", kind, n, path, &stack);
  return true;
}

bool is_asked(int kind) {
  return plan.ready && !inside && (plan.counting || plan.kind == kind);
}

}  // namespace

bool fails(int kind, const void* caller) {
  if (!is_asked(kind)) return false;
  const int before = errno;
  inside = true;
  const bool failing = count(kind, nullptr, caller);
  inside = false;
  errno = failing ? plan.error : before;
  return failing;
}

bool allocation_fails(std::size_t size, const void* caller) {
  return fails(malloc_, caller) || (size >= large && fails(large_malloc, caller));
}

bool fails_at(int kind, int folder, const char* path, const void* caller) {
  if (!is_asked(kind) || path == nullptr) return false;
  const int before = errno;
  inside = true;
  char whole[8192] = "";
  long length = 0;
  if (path[0] != '/' || path[1] == '\0') {
    char link[64];
    std::snprintf(link, sizeof link, folder == AT_FDCWD ? "/proc/self/cwd" : "/proc/self/fd/%d", folder);
    length = path[0] == '/' ? 0 : std::max(syscall(SYS_readlink, link, whole, 4000), 0L);
    if (path[0] != '\0' && length > 0) whole[length++] = '/';
  }
  std::snprintf(whole + length, sizeof whole - static_cast<std::size_t>(length), "%s", path);
  const bool failing = (kind == descriptor || lies_in_folders(whole)) && count(kind, whole, caller);
  inside = false;
  errno = failing ? plan.error : before;
  return failing;
}

bool fails_on(int kind, int file, const void* caller) {
  return file >= 0 && fails_at(kind, file, "", caller);
}

}  // namespace gnomon::faults
