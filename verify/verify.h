// gnomon verify: the hard cases of rays and of depth maps, run on this machine. A case tries many rays
// against an oracle that shares no code with the tracer: closed forms, 128-bit or exact arithmetic, or the
// topology of a closed mesh. It says how many were wrong and how large the worst error was. The numbers of
// the cases are fixed: other programs read them. Results depend on the seed and the number of rays alone,
// never on threads.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raytrace/tracer.h"

namespace gnomon::verify {

class Run;

struct Case {
  int number;             ///< from 1
  std::string_view name;  ///< lower case with underscores: also the name of its test
  std::string_view what;  ///< one line: what is asked of the tracer
  void (*run)(Run&);
};

/// Every case, in ascending order of numbers.
std::span<const Case> all_cases();

struct Outcome {
  std::uint64_t tried = 0, wrong = 0;
  double worst = 0.0;  ///< the largest error met, in the row's own unit
};

/// One line of the table; a case has one or more.
struct Row {
  int number = 0;
  std::string name;
  std::string unit;    ///< of worst and bound; empty: the row only counts
  double bound = 0.0;  ///< what worst must not exceed
  Outcome outcome;
  std::optional<Outcome> naive;  ///< the textbook formulation on the same rays, when asked for
  std::string skipped{};         ///< why this machine cannot run it: then nothing is wrong with it
  bool ok() const {
    return !skipped.empty() || (outcome.tried > 0 && outcome.wrong == 0 && outcome.worst <= bound);
  }
};

struct Options {
  std::uint64_t rays = 1'000'000;  ///< of a case; costly ones take a stated share of it
  std::uint64_t seed = 1;
  raytrace::Precision precision = raytrace::Precision::robust;
  bool show_naive = false;  ///< run the textbook formulation on the same rays too
};

/// Called between blocks of rays with the row's name and the share of the case done in [0, 1].
using Progress = std::function<void(std::string_view row, double done)>;

std::vector<Row> run_case(const Case& which, const Options& options, const Progress& progress = {});

}  // namespace gnomon::verify
