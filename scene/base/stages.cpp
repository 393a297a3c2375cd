#include "scene/base/stages.h"

#include <fmt/core.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

namespace gnomon {
namespace {

thread_local StageLog* log_of_thread = nullptr;

/// How long ago the process was started, by the kernel's own record. It is field 22 of /proc/self/stat (proc(5)),
/// in clock ticks since boot, so that the true start lies up to one tick later. Less than 0: not known.
double age_by_kernel_ms(double tick_ms) {
  std::ifstream file("/proc/self/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');  // the name may hold anything
  if (name_end == std::string::npos) return -1.0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string field;
  for (int number = 3; number <= 22; ++number) fields >> field;
  const double ticks = std::strtod(field.c_str(), nullptr);
  return ticks > 0.0 ? clock_ms(CLOCK_BOOTTIME) - ticks * tick_ms : -1.0;
}

/// Before main only one thread runs, so no less wall-clock time has passed than processor time. The kernel's
/// record is coarser but knows of waiting, such as for libraries that come from a slow disk. It counts where
/// the two differ by more than its own tick.
double age_ms(double cpu_ms) {
  const double tick_ms = 1e3 / static_cast<double>(::sysconf(_SC_CLK_TCK));
  return std::max(cpu_ms, age_by_kernel_ms(tick_ms) - tick_ms);
}

}  // namespace

const StageTime* TimeBudget::find(std::string_view stage) const {
  const auto found =
      std::find_if(stages.begin(), stages.end(), [&](const StageTime& s) { return s.stage == stage; });
  return found != stages.end() ? &*found : nullptr;
}

StageLog::StageLog() : start_(now()), last_(start_) {
  // Processor time is counted from the start of the process.
  start_ = {start_.wall_ms - age_ms(start_.cpu_ms), 0.0};
  last_ = start_;
  open_.push_back({"start", start_, {}});
  charge();
  runs_.push_back({"start", start_, last_});
  open_.front() = {"rest", last_, {}};
  log_of_thread = this;
}

StageLog::~StageLog() {
  log_of_thread = nullptr;
}

StageLog* StageLog::current() {
  return log_of_thread;
}

StageLog::Clock StageLog::now() {
  return {clock_ms(CLOCK_MONOTONIC), clock_ms(CLOCK_PROCESS_CPUTIME_ID)};
}

StageTime& StageLog::account(std::string_view stage) {
  const auto found =
      std::find_if(accounts_.begin(), accounts_.end(), [&](const StageTime& s) { return s.stage == stage; });
  return found != accounts_.end() ? *found : accounts_.emplace_back(StageTime{stage});
}

void StageLog::charge() {
  const Clock time = now();
  StageTime& innermost = account(open_.back().stage);
  innermost.wall_ms += time.wall_ms - last_.wall_ms;
  innermost.cpu_ms += time.cpu_ms - last_.cpu_ms;
  last_ = time;
}

void StageLog::enter(std::string_view stage) {
  charge();
  open_.push_back({stage, last_, {}});
}

void StageLog::leave() {
  charge();
  if (keeps_runs_) runs_.push_back({open_.back().stage, open_.back().begin, last_});
  open_.pop_back();
}

TimeBudget StageLog::budget() const {
  const Clock time = now();
  TimeBudget out{accounts_, time.wall_ms - start_.wall_ms, time.cpu_ms - start_.cpu_ms};
  for (StageTime& stage : out.stages)
    if (stage.stage == open_.back().stage) {
      stage.wall_ms += time.wall_ms - last_.wall_ms;
      stage.cpu_ms += time.cpu_ms - last_.cpu_ms;
    }
  return out;
}

std::string StageLog::trace(std::string_view process_name) const {
  std::string text = fmt::format(
      R"({{"displayTimeUnit": "ms", "traceEvents": [
{{"name": "process_name", "ph": "M", "pid": 1, "tid": 1, "args": {{"name": "{}"}}}})",
      process_name);
  for (const Run& run : runs_)
    text += fmt::format(
        ",\n{{\"name\": \"{}\", \"cat\": \"stage\", \"ph\": \"X\", \"pid\": 1, \"tid\": 1, \"ts\": {:.3f}, "
        "\"dur\": {:.3f}, \"args\": {{\"cpu_ms\": {:.3f}}}}}",
        run.stage, 1e3 * (run.begin.wall_ms - start_.wall_ms), 1e3 * (run.end.wall_ms - run.begin.wall_ms),
        run.end.cpu_ms - run.begin.cpu_ms);
  return text + "\n]}\n";
}

TimedStage::TimedStage(std::string_view name, Inner inner) : log_(log_of_thread) {
  if (log_ == nullptr) return;
  log_->enter(name);
  if (inner == Inner::included) hidden_ = std::exchange(log_of_thread, nullptr);
}

void TimedStage::end() {
  if (log_ == nullptr) return;
  if (hidden_ != nullptr) log_of_thread = hidden_;
  std::exchange(log_, nullptr)->leave();
}

}  // namespace gnomon
