#include "scene/base/time_difference.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace gnomon {
namespace {

constexpr std::size_t least_runs = 3;  ///< that say something of their spread

struct TimeRange {
  double low = 0.0, high = 0.0;
};

// A quarter of the values lie below and above, rounded down: none of three or four.
TimeRange quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t outside = (values.size() - 1) / 4;
  return {values[outside], values[values.size() - 1 - outside]};
}

/// The range of some runs' times: `alone_ms`, of which a quarter counts where the runs are too few to tell.
TimeRange interval(const Times& runs, double alone_ms) {
  const double middle = runs.median(), off = single_run_share * alone_ms;
  if (runs.runs.size() < least_runs) return {middle - off, middle + off};
  const TimeRange inner = quartiles(runs.runs);
  const double spread = inner.high - inner.low;
  return {inner.low - spread, inner.high + spread};
}

Times run_by_run(const Times& of, const Times& part) {
  Times out;
  for (std::size_t i = 0; i < std::min(of.runs.size(), part.runs.size()); ++i)
    out.runs.push_back(of.runs[i] - part.runs[i]);
  return out;
}

constexpr std::size_t no_run = std::numeric_limits<std::size_t>::max();

double least_without(const Times& times, std::size_t left_out) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < times.runs.size(); ++i)
    if (i != left_out) least = std::min(least, times.runs[i]);
  return least;
}

double difference_of_least(const TimedStrip& strip, std::size_t left_out) {
  return least_without(strip.whole, left_out) - least_without(strip.part, left_out);
}

/// The variance of a strip's difference_of_least(), by leaving out one run after the other.
double jackknife_variance(const TimedStrip& strip, std::size_t runs) {
  const auto count = static_cast<double>(runs);
  std::vector<double> without;
  for (std::size_t i = 0; i < runs; ++i) without.push_back(difference_of_least(strip, i));
  const double mean = std::accumulate(without.begin(), without.end(), 0.0) / count;
  double squares = 0.0;
  for (const double one : without) squares += (one - mean) * (one - mean);
  return (count - 1.0) / count * squares;
}

struct Estimate {
  double ms = 0.0, error_ms = 0.0;
};

/// Of strips that were run one after the other, so that their errors have nothing to do with each other.
Estimate sum_of_least(std::span<const TimedStrip> strips, std::size_t runs) {
  Estimate sum;
  double variance = 0.0;
  for (const TimedStrip& strip : strips)
    sum.ms += difference_of_least(strip, no_run), variance += jackknife_variance(strip, runs);
  sum.error_ms = std::sqrt(variance);
  return sum;
}

/// Run by run over all strips; of a strip that was run less often, no more than its runs.
TimedStrip sum_of(std::span<const TimedStrip> strips) {
  TimedStrip sum;
  for (const TimedStrip& strip : strips) sum.whole.add_part(strip.whole), sum.part.add_part(strip.part);
  return sum;
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

TimeDifference beyond_part(std::span<const TimedStrip> strips) {
  constexpr double errors = 2.0;
  const TimedStrip all = sum_of(strips);
  TimeDifference out;
  out.pairs = run_by_run(all.whole, all.part);
  if (!out.timed()) return out;
  const std::size_t runs = out.pairs.runs.size();
  const bool few = runs < 2 || strips.size() * (runs - 1) < least_runs - 1;
  const Estimate least = few ? Estimate{} : sum_of_least(strips, runs);
  const double found = few ? out.pairs.median() : least.ms;
  const double off = few ? single_run_share * all.part.median() : errors * least.error_ms;
  out.low = std::max(0.0, found - off);
  out.high = std::max({0.0, found + off, -found});
  out.median = std::clamp(found, out.low, out.high);
  out.told = out.low > 0.0;
  return out;
}

TimeDifference beyond_part(const Times& whole, const Times& part) {
  const TimedStrip one{whole, part};
  return beyond_part(std::span(&one, 1));
}

TimeDifference with_spread(const Times& pass) {
  TimeDifference out{.pairs = pass};
  if (!out.timed()) return out;
  const TimeRange range = interval(pass, pass.median());
  out.low = std::max(0.0, range.low), out.median = pass.median(), out.high = range.high, out.told = true;
  return out;
}

bool clearly_faster(const Times& a, const Times& b, bool in_turn) {
  if (a.runs.empty() || b.runs.empty()) return false;
  if (in_turn) return interval(run_by_run(b, a), a.median()).low > 0.0;
  if (std::min(a.runs.size(), b.runs.size()) < least_runs)
    return b.median() - a.median() > single_run_share * a.median();
  return quartiles(b.runs).low > quartiles(a.runs).high;
}

}  // namespace gnomon
