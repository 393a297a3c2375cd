#include "verify/run.h"

#include "scene/base/parallel.h"

namespace gnomon::verify {

namespace {

constexpr std::uint64_t block_trials = 1024;
constexpr std::uint64_t blocks_between_reports = 512;

std::uint64_t block_seed(std::uint64_t seed, int number, std::size_t row, std::uint64_t block) {
  Random mix(seed);
  for (const std::uint64_t part : {static_cast<std::uint64_t>(number), std::uint64_t{row}, block})
    mix = Random(mix.next() ^ part);
  return mix.next();
}

}  // namespace

std::uint64_t Run::rays(double share, std::uint64_t most) const {
  const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(options_.rays));
  return std::min(std::max(wanted, std::uint64_t{256}), most);
}

void Run::blocks(Row row, std::uint64_t trials, const Block& block) {
  const std::uint64_t count = (trials + block_trials - 1) / block_trials;
  std::vector<Tally> tallies(blocks_between_reports);
  for (std::uint64_t first = 0; first < count; first += blocks_between_reports) {
    if (progress_) progress_(row.name, static_cast<double>(first) / static_cast<double>(count));
    const std::uint64_t end = std::min(count, first + blocks_between_reports);
    parallel_for(end - first, [&](std::uint64_t i) {
      const std::uint64_t b = first + i;
      Random random(block_seed(options_.seed, number_, rows_.size(), b));
      Tally tally;
      block(random, std::min(block_trials, trials - b * block_trials), tally);
      tallies[i] = tally;
    });
    for (std::uint64_t b = first; b < end; ++b) {
      const Tally& tally = tallies[b - first];
      row.outcome.tried += tally.tried;
      row.outcome.wrong += tally.wrong;
      row.outcome.worst = std::max(row.outcome.worst, tally.worst);
    }
  }
  rows_.push_back(std::move(row));
}

std::vector<Row> run_case(const Case& which, const Options& options, const Progress& progress) {
  Run run(which.number, options, false, progress);
  which.run(run);
  std::vector<Row> rows = run.take_rows();
  if (!options.show_naive) return rows;
  Run naive(which.number, options, true, progress);
  which.run(naive);
  const std::vector<Row> naive_rows = naive.take_rows();
  for (std::size_t i = 0; i < std::min(rows.size(), naive_rows.size()); ++i)
    rows[i].naive = naive_rows[i].outcome;
  return rows;
}

}  // namespace gnomon::verify
