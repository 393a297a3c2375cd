// Signals are process-wide, and so is this file's state.
#include "app/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <thread>

#include "scene/files/path_status.h"

namespace gnomon::app {

namespace {

constexpr std::array watched_signals{SIGINT, SIGTERM};
std::atomic<int> received_signal{0};

std::mutex& output_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Of the folders that live; the mutex of the outputs guards it.
std::list<std::string>& temporary_folders() {
  static std::list<std::string> folders;
  return folders;
}

/// As far as that works: nobody is left to be told.
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
  const std::lock_guard<std::mutex> outputs_are_whole(output_mutex());
  for (const std::string& folder : temporary_folders()) remove_folder(folder);
  const std::string_view text =
      isatty(STDERR_FILENO) == 1 ? "\r\033[Kgnomon: interrupted\n" : "gnomon: interrupted\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
  _exit(exit_code_of(signal_number));
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

OutputGuard::OutputGuard() : lock_(output_mutex()) {}

RemovedOnSignal::RemovedOnSignal(const std::string& path) {
  const OutputGuard guard;
  place_ = temporary_folders().insert(temporary_folders().end(), path);
}

RemovedOnSignal::~RemovedOnSignal() {
  const OutputGuard guard;
  temporary_folders().erase(place_);
}

TemporaryFolder::TemporaryFolder(const std::string& name) {
  const OutputGuard guard;
  std::error_code error;
  std::string path = (std::filesystem::temp_directory_path(error) / (name + "-XXXXXX")).string();
  if (error || mkdtemp(path.data()) == nullptr) path.clear();
  place_ = temporary_folders().insert(temporary_folders().end(), path);
}

TemporaryFolder::~TemporaryFolder() {
  const OutputGuard guard;
  remove_folder(*place_);
  temporary_folders().erase(place_);
}

}  // namespace gnomon::app
