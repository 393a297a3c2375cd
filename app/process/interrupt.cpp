// Signals are process-wide, and so is this file's state.
#include "app/process/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>
#include <thread>

#include "scene/base/run_program.h"
#include "scene/base/terminal.h"
#include "scene/base/threads.h"
#include "scene/files/path_status.h"
#include "scene/files/staged_folder.h"
#include "scene/files/unfinished_files.h"

namespace gnomon::app {

namespace {

constexpr std::array watched_signals{SIGINT, SIGTERM};
std::atomic<int> received_signal{0};

std::mutex& output_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// The folders that live.
struct TemporaryFolders {
  std::mutex mutex;
  std::list<std::string> paths;
};
TemporaryFolders& temporary_folders() {
  static TemporaryFolders folders;
  return folders;
}

/// Removes what it can: nobody is left to be told of the rest.
void remove_folder(const std::string& path) {
  if (!path.empty()) (void)remove_all_of(path);
}

bool is_ignored(int signal_number) {
  struct sigaction current {};
  return sigaction(signal_number, nullptr, &current) == 0 && current.sa_handler == SIG_IGN;
}

int exit_code_of(int signal_number) {
  return 128 + signal_number;  // as a shell counts
}

void wait_and_exit(sigset_t awaited) {
  int signal_number = 0;
  if (sigwait(&awaited, &signal_number) != 0) return;
  received_signal = signal_number;
  end_programs();  // for which the holder of the outputs may wait
  const std::lock_guard<std::mutex> outputs_are_whole(output_mutex());
  end_process(exit_code_of(signal_number), "interrupted");
}

}  // namespace

void watch_for_interrupts() {
  sigset_t awaited;
  sigemptyset(&awaited);
  bool any = false;
  for (const int signal_number : watched_signals) {
    if (is_ignored(signal_number)) continue;
    sigaddset(&awaited, signal_number);
    any = true;
  }
  if (!any) return;
  pthread_sigmask(SIG_BLOCK, &awaited, nullptr);
  try {
    const RefusalIsHandled goes_on;
    std::thread(wait_and_exit, awaited).detach();
  } catch (const std::system_error&) {  // no thread can be started: signals end the process where it stands
    pthread_sigmask(SIG_UNBLOCK, &awaited, nullptr);
  }
}

void leave_interrupts_to_the_system() {
  sigset_t blocked;
  sigemptyset(&blocked);
  for (const int signal_number : watched_signals) sigaddset(&blocked, signal_number);
  pthread_sigmask(SIG_UNBLOCK, &blocked, nullptr);
}

int interrupt_exit_code() {
  const int signal_number = received_signal;
  return signal_number == 0 ? 0 : exit_code_of(signal_number);
}

// Memory may be what is missing.
void end_process(int exit_code, std::string_view words) {
  TemporaryFolders& folders = temporary_folders();
  folders.mutex.lock();  // for good: no other is made any more
  remove_unfinished_files();
  try {
    for (const std::string& folder : folders.paths) remove_folder(folder);
    StagedFolder::remove_all_at_the_end();
  } catch (const std::bad_alloc&) {  // it stays
  }
  const std::string_view start = is_terminal(STDERR_FILENO) ? "\r\033[Kgnomon: " : "gnomon: ";
  for (const std::string_view part : {start, words, std::string_view("\n")})
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, part.data(), part.size());
  _exit(exit_code);
}

OutputGuard::OutputGuard() : lock_(output_mutex()) {}

TemporaryFolder::TemporaryFolder(const std::string& name) {
  TemporaryFolders& folders = temporary_folders();
  const std::lock_guard lock(folders.mutex);
  std::error_code error;
  std::string path = (std::filesystem::temp_directory_path(error) / (name + "-XXXXXX")).string();
  if (error || mkdtemp(path.data()) == nullptr)
    path.clear();
  else if (access(path.c_str(), R_OK | W_OK | X_OK) != 0) {  // the umask takes it away from its maker
    rmdir(path.c_str());
    path.clear();
  }
  place_ = folders.paths.insert(folders.paths.end(), path);
}

TemporaryFolder::~TemporaryFolder() {
  TemporaryFolders& folders = temporary_folders();
  const std::lock_guard lock(folders.mutex);
  remove_folder(*place_);
  folders.paths.erase(place_);
}

}  // namespace gnomon::app
