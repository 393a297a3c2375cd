// The same check for every instruction set that this machine has and Highway compiled for.
#pragma once

#include <hwy/targets.h>

namespace gnomon::test {

template <class Check>
void for_each_target(const Check& check) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace gnomon::test
