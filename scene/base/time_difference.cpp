#include "scene/base/time_difference.h"

namespace gnomon {
namespace {

struct TimeRange {
  double low = 0.0, high = 0.0;
};

// A quarter of the values lie below and above, rounded down: none of three or four.
TimeRange quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t outside = (values.size() - 1) / 4;
  return {values[outside], values[values.size() - 1 - outside]};
}

Times run_by_run(const Times& of, const Times& part) {
  Times out;
  for (std::size_t i = 0; i < std::min(of.runs.size(), part.runs.size()); ++i)
    out.runs.push_back(of.runs[i] - part.runs[i]);
  return out;
}

constexpr std::size_t least_runs = 3;

// `pairs` is not empty.
TimeRange interval_in_turn(const Times& pairs, const Times& shorter) {
  const double middle = pairs.median(), off = single_run_share * shorter.median();
  if (pairs.runs.size() < least_runs) return {middle - off, middle + off};
  const TimeRange inner = quartiles(pairs.runs);
  const double spread = inner.high - inner.low;
  return {inner.low - spread, inner.high + spread};
}

}  // namespace

TimeDifference& TimeDifference::operator+=(const TimeDifference& other) {
  if (!other.timed()) return *this;
  told = timed() ? told && other.told : other.told;
  if (timed())
    pairs.add_part(other.pairs);
  else
    pairs = other.pairs;
  low += other.low, median += other.median, high += other.high;
  return *this;
}

TimeDifference& TimeDifference::operator+=(double ms) {
  for (double& pair : pairs.runs) pair += ms;
  low += ms, median += ms, high += ms;
  return *this;
}

TimeDifference beyond_part(const Times& whole, const Times& part) {
  TimeDifference out;
  out.pairs = run_by_run(whole, part);
  if (!out.timed()) return out;
  const TimeRange found = interval_in_turn(out.pairs, part);
  out.low = std::max(0.0, found.low);
  out.high = std::max({0.0, found.high, -out.pairs.least()});
  out.median = std::clamp(out.pairs.median(), out.low, out.high);
  out.told = out.low > 0.0;
  return out;
}

bool clearly_faster(const Times& a, const Times& b, bool in_turn) {
  if (a.runs.empty() || b.runs.empty()) return false;
  if (in_turn) return interval_in_turn(run_by_run(b, a), a).low > 0.0;
  if (std::min(a.runs.size(), b.runs.size()) < least_runs)
    return b.median() - a.median() > single_run_share * a.median();
  return quartiles(b.runs).low > quartiles(a.runs).high;
}

}  // namespace gnomon
