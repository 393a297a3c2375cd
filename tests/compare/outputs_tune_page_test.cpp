// What the tuner's page says of a bias that is not right everywhere.
#include <gtest/gtest.h>

#include "studies/tune/page.h"

namespace gnomon::studies {
namespace {

std::string tuned_page(double needs_more_than, double needs_less_than) {
  TuneGoal goal;
  goal.max_error = compare::Threshold{compare::find_measure("wrong"), 1e-6};
  TuneResult result;
  FamilyResult& family = result.families.emplace_back();
  family.family.name = "slope bias 1";
  family.family.map.bias.slope = 1.0;
  family.closest.size = 64, family.closest.texel_world = 0.0125;
  family.closest.best = {0.0, 0.01, false, needs_more_than, needs_less_than, 213, 97};
  const std::vector<std::string> commands{"gnomon compare ball"};
  return tune_introduction({"ball", goal, result, commands, {}}).facts;
}

// The tuner says why no constant bias is right as the verdict does.
TEST(TunePage, NamesNoNeedThatIsNone) {
  const std::string both = tuned_page(0.031, 0.012);
  EXPECT_NE(both.find("No constant bias beside the slope bias of"), std::string::npos) << both;
  EXPECT_NE(both.find("lit pixels stay dark below"), std::string::npos) << both;
  EXPECT_NE(both.find("\"proof_has_both\":true"), std::string::npos) << both;
  const std::string shadowed = tuned_page(-0.00012, -0.003);
  EXPECT_EQ(shadowed.find("stay dark below"), std::string::npos) << shadowed;
  EXPECT_NE(shadowed.find("shadowed pixels are lit even at bias 0."), std::string::npos) << shadowed;
  EXPECT_NE(shadowed.find("\"proof_has_both\":false"), std::string::npos) << shadowed;
  const std::string nothing = tuned_page(0.031, -infinity);
  EXPECT_NE(nothing.find("some shadowed pixels find no caster in the map."), std::string::npos);
  EXPECT_EQ(nothing.find("unlimited"), std::string::npos) << nothing;
}

}  // namespace
}  // namespace gnomon::studies
