// Writes the outputs of hand-made comparisons (one light, three lights, nothing compared, more pixels than a page shows)
// into folders below the one given, for the browser test of the report page; and the page of several captures.
#include <filesystem>
#include <iostream>

#include "report/write_outputs.h"
#include "studies/judge/several.h"
#include "tests/synthetic_comparison.h"

namespace {

bool write(const gnomon::compare::Comparison& comparison, const std::string& folder) {
  const auto paths = gnomon::compare::write_outputs(comparison, {.folder = folder});
  if (!paths) std::cerr << paths.error().message() << '\n';
  return paths.has_value();
}

/// A capture with figures, one of which nothing was compared, and one that was refused.
bool write_captures(const std::string& folder) {
  gnomon::compare::JudgedSet set;
  gnomon::compare::JudgedRow judged, empty;
  empty.name = "empty";
  judged.name = "shot#1 <b>", judged.scene = "fence", judged.renderer = "Another 2.0",
  judged.labels = "acne 12";
  judged.advice = "bias 0.002 instead of 0.001", judged.compared = 100, judged.wrong = 0.125,
  judged.mean_error = 0.25;
  judged.edge_pixels = 1.5, judged.detachment_world = 0.0625;
  set.rows = {empty, judged};
  set.add_refused("refused", "no such file");
  std::filesystem::create_directories(folder);
  return gnomon::compare::write_judged_set(set, folder).has_value();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: outputs_sample FOLDER\n";
    return 2;
  }
  const std::string folder = argv[1];
  const auto one = gnomon::compare::make_synthetic(1), three = gnomon::compare::make_synthetic(3),
             none = gnomon::compare::make_synthetic(1), large = gnomon::compare::make_synthetic(1);
  gnomon::compare::clear_comparison(none->comparison.lights[0]);
  for (gnomon::raster::LightRecord& record : three->comparison.raster.lights)
    record.unshadowed_pass.runs = {1.0};  // so that the page says what shadows alone cost
  three->scene.lights[1].name = "Point_light_over_the_long_table_001";  // as modelling programs name them
  large->comparison.raster.options.size = {10000, 5625};  // as it says of itself; its images stay small
  return write(one->comparison, folder + "/one") && write(three->comparison, folder + "/three") &&
                 write(none->comparison, folder + "/none") && write(large->comparison, folder + "/large") &&
                 write_captures(folder + "/captures")
             ? 0
             : 1;
}
