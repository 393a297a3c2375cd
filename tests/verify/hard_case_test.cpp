// One hard case of `gnomon verify` with few rays: hard_case_test 01_shared_edges. With --complete and every
// name, whether they are the cases of the program, no more and no fewer.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "verify/verify.h"

namespace gnomon::verify {
namespace {

std::string test_name(const Case& c) {
  return fmt::format("{:02}_{}", c.number, c.name);
}

bool run_with(const Case& which, raytrace::Precision precision) {
  bool ok = true;
  const Options options{.rays = 10000, .seed = 1, .precision = precision};
  for (const Row& row : run_case(which, options)) {
    if (!row.skipped.empty()) {
      fmt::print("{} {}: skipped: {}\n", raytrace::precision_name(precision), row.name, row.skipped);
      continue;
    }
    fmt::print("{} {}: tried {}, wrong {}, worst {:.3g} {} (bound {:.3g}){}\n",
               raytrace::precision_name(precision), row.name, row.outcome.tried, row.outcome.wrong,
               row.outcome.worst, row.unit, row.bound, row.ok() ? "" : " FALLS SHORT");
    ok = ok && row.ok();
  }
  return ok;
}

int run_named(const std::string& name) {
  const auto cases = all_cases();
  const auto found =
      std::find_if(cases.begin(), cases.end(), [&](const Case& c) { return test_name(c) == name; });
  if (found == cases.end()) {
    fmt::print("no such case: {}\n", name);
    return 1;
  }
  bool ok = true;
  for (const auto precision : {raytrace::Precision::robust, raytrace::Precision::exact})
    ok = run_with(*found, precision) && ok;
  return ok ? 0 : 1;
}

int check_complete(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Case& c : all_cases()) known.push_back(test_name(c));
  if (known == names) return 0;
  fmt::print("the tests are not the program's cases, in their order\n");
  return 1;
}

}  // namespace
}  // namespace gnomon::verify

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) return 2;
  if (words.front() != "--complete") return gnomon::verify::run_named(words.front());
  words.erase(words.begin());
  return gnomon::verify::check_complete(words);
}
