// Older instruction sets that gnomon_bench holds both programs to.
#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <map>
#include <string>

namespace gnomon::bench {

struct InstructionSet {
  const char* embree;
  std::int64_t highway;
};

/// What other machines have, tried on this one: both are held to the same.
inline const std::map<std::string, InstructionSet>& instruction_sets() {
  static const std::map<std::string, InstructionSet> sets{{"avx2", {"isa=avx2", HWY_AVX2}},
                                                          {"sse4", {"isa=sse4.2", HWY_SSE4}}};
  return sets;
}

/// False: this machine does not have it.
inline bool hold_to(const std::string& target) {
  const std::int64_t wanted = instruction_sets().at(target).highway;
  if ((hwy::SupportedTargets() & wanted) == 0) return false;
  hwy::SetSupportedTargetsForTest(wanted);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return true;
}

}  // namespace gnomon::bench
