// What compiling costs, in processor seconds: what somebody waits for who has just got the sources.
#pragma once

#include <string>
#include <vector>

#include "benchmark/row.h"
#include "scene/base/expected.h"

namespace gnomon::bench {

/// Compiles the project at `sources` in a folder of its own that is removed again, from nothing and without a compiler's cache, as
/// `./gnomon compare` does on a fresh machine. A row for each of `programs` in turn has the processor seconds of all compilers and
/// linkers that it took beyond those before it. Errors: bad input where `sources` is no such project; graphics where a tool is
/// missing; what the tools say goes to stderr.
Expected<BenchResult> bench_build(const std::string& sources, const std::vector<std::string>& programs,
                                  const Progress& progress);

}  // namespace gnomon::bench
