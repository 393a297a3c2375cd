#include "lab/view/work/job.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "scene/base/interrupted.h"
#include "scene/files/own_program.h"

namespace gnomon::lab {

namespace {

/// Between fork and exec: system calls alone.
[[noreturn]] void become(const char* program, char* const* words, int out, int err) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  execv(program, words);
  _exit(127);
}

std::string all_of(int file) {
  std::string text;
  char buffer[4096];
  off_t place = 0;
  for (ssize_t count = 0; (count = pread(file, buffer, sizeof buffer, place)) > 0; place += count)
    text.append(buffer, static_cast<std::size_t>(count));
  return text;
}

}  // namespace

Expected<std::unique_ptr<Job>> Job::start(std::string title, const std::vector<std::string>& words) {
  std::unique_ptr<Job> job(new Job);
  job->title_ = std::move(title);
  job->out_ = memfd_create("out", MFD_CLOEXEC);
  job->err_ = memfd_create("err", MFD_CLOEXEC);
  std::vector<char*> arguments{const_cast<char*>("gnomon")};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::string program = program_beside("gnomon");
  if (job->out_ >= 0 && job->err_ >= 0) job->child_ = fork();
  if (job->child_ == 0) become(program.c_str(), arguments.data(), job->out_, job->err_);
  if (job->child_ < 0)
    return fail(ErrorKind::graphics, std::string("cannot start a process: ") + std::strerror(errno));
  return job;
}

Job::~Job() {
  if (child_ > 0) {
    kill(child_, SIGKILL);
    uninterrupted([&] { return waitpid(child_, nullptr, 0); });
  }
  for (const int file : {out_, err_})
    if (file >= 0) close(file);
}

bool Job::ended() {
  if (child_ < 0) return true;
  int status = 0;
  const pid_t done = waitpid(child_, &status, WNOHANG);
  if (done == 0 || (done < 0 && errno == EINTR)) return false;
  child_ = -1;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

std::string Job::out() const {
  return all_of(out_);
}
std::string Job::err() const {
  return all_of(err_);
}

}  // namespace gnomon::lab
