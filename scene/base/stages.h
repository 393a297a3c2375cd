// The time budget of a process: where its wall-clock and its processor time went, stage by stage, so that the
// stages add up to the whole. At every moment just one stage runs; a stage inside another one stops the outer
// one's clock. Processor time is that of all threads while the stage ran.
#pragma once

#include <ctime>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// What one stage took, in milliseconds, over all the times that it ran.
struct StageTime {
  std::string_view stage;
  double wall_ms = 0.0, cpu_ms = 0.0;
};

/// The stages in the order in which they first ran; they sum to the process so far.
struct TimeBudget {
  std::vector<StageTime> stages;
  double wall_ms = 0.0, cpu_ms = 0.0;  ///< of the process, since its start
  const StageTime* find(std::string_view stage) const;
};

/// Keeps the account of the process. The thread that makes one charges its stages to it; on other threads,
/// and where there is no log, a TimedStage costs a look at a pointer.
class StageLog {
 public:
  /// What ran since the process was started is charged to `start`, and what no other stage takes is to
  /// `rest`.
  StageLog();
  ~StageLog();
  StageLog(const StageLog&) = delete;
  StageLog& operator=(const StageLog&) = delete;

  /// Up to now.
  TimeBudget budget() const;
  /// The innermost stage that runs now, also where an outer one includes it (TimedStage::Inner::included).
  std::string_view running() const { return open_.back().stage; }
  /// Whether every single run of a stage is kept, for trace(); off at first.
  void keep_runs(bool keep) { keeps_runs_ = keep; }
  /// The runs as a document in the Trace Event Format (JSON object form, complete events "X", microseconds),
  /// which Perfetto and chrome://tracing open.
  std::string trace(std::string_view process_name) const;

  /// The log of this thread, if it has one.
  static StageLog* current();

 private:
  friend class TimedStage;
  struct Clock {
    double wall_ms = 0.0, cpu_ms = 0.0;
  };
  struct Run {
    std::string_view stage;
    Clock begin, end;
  };
  static Clock now();
  void enter(std::string_view stage);
  void leave();
  void charge();  ///< what has run since the last call to the innermost stage
  StageTime& account(std::string_view stage);

  Clock start_, last_;  ///< on the clocks of now()
  std::vector<StageTime> accounts_;
  std::vector<Run> open_, runs_;
  bool keeps_runs_ = false;
};

/// Charges the scope that it lives in. The name must outlive the log.
class TimedStage {
 public:
  enum class Inner { apart, included };
  /// included: stages inside this one are charged to it as well, as is meant for runs that only repeat a
  /// stage.
  explicit TimedStage(std::string_view name, Inner inner = Inner::apart);
  ~TimedStage() { end(); }
  TimedStage(const TimedStage&) = delete;
  TimedStage& operator=(const TimedStage&) = delete;
  /// Before the scope ends.
  void end();

 private:
  StageLog* log_;
  StageLog* hidden_ = nullptr;  ///< put back at the end
};

// The clocks of the system.

/// Milliseconds of a clock of clock_gettime().
inline double clock_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace gnomon
