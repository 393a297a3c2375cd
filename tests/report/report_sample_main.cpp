// Writes the outputs of hand-made comparisons (one light, three lights, nothing compared, more pixels than a page shows,
// a difference that is none) into folders below the one given, for the browser test of the report page; the page of
// several captures; and numbers as the program writes them.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "compare/result/number_text.h"
#include "judge/several.h"
#include "report/write_outputs.h"
#include "tests/support/synthetic_comparison.h"

namespace {

bool write(const gnomon::compare::Comparison& comparison, const std::string& folder) {
  const auto paths = gnomon::report::write_outputs(comparison, {.folder = folder});
  if (!paths) std::cerr << paths.error().message() << '\n';
  return paths.has_value();
}

/// What was drawn differs from the truth by no more than the rounding of sums.
void cancel_out(gnomon::compare::LightComparison& light) {
  light.budget = {};
  light.budget[1] = {.signed_mean = 0.1, .absolute_mean = 0.3};
  light.budget[4] = {.signed_mean = 0.2, .absolute_mean = 0.2};
  light.budget[5] = {.signed_mean = -0.3, .absolute_mean = 0.3};
  light.rung_mean.fill(0.3);
  light.rung_mean.back() = 0.1 + 0.2;
}

/// A capture with figures, one of which nothing was compared, and one that was refused.
bool write_captures(const std::string& folder) {
  gnomon::judge::JudgedSet set;
  gnomon::judge::JudgedRow judged, empty;
  empty.name = "empty";
  judged.name = "shot#1 <b>", judged.scene = "fence", judged.renderer = "Another 2.0",
  judged.labels = "acne 12";
  judged.advice = "bias 0.002 instead of 0.001";
  gnomon::compare::LightFigures& figures = judged.figures;
  figures.pixels.compared = 100, figures.error.wrong_fraction = 0.125, figures.error.mean_absolute = 0.25;
  figures.edges.rms_pixels = 1.5, figures.detachment.pixels = 1, figures.detachment.mean_world = 0.0625;
  set.rows = {empty, judged};
  set.add_refused("refused", "no such file");
  std::filesystem::create_directories(folder);
  return gnomon::judge::write_judged_set(set, folder).has_value();
}

/// Each with its texts, by the functions of compare/result/number_text.h.
void write_numbers(const std::string& path) {
  using namespace gnomon::compare;  // their names are what the list is about
  std::vector<double> values;
  for (int exponent = -7; exponent <= 9; ++exponent)
    for (const double digits : {1.0, 1.2345, 2.71, 4.999, 9.949, 9.994, 9.996, 9.9999})
      values.push_back(digits * std::pow(10.0, exponent));
  for (int i = 1; i <= 96; ++i)
    values.push_back(i / 32.0), values.push_back(i * 12.5);  // middles of decimals
  nlohmann::json list = nlohmann::json::array();
  for (const double v : values)
    list.push_back({{"value", v},
                    {"percent", percent(v)},
                    {"plainNumber", plain_number(v)},
                    {"unsignedNumber", unsigned_number(v)},
                    {"signedNumber", signed_number(-v)},
                    {"texelsText", texels_text(v)},
                    {"milliseconds", milliseconds(v)},
                    {"byteCount", byte_count(static_cast<std::uint64_t>(v))},
                    {"grouped", grouped(static_cast<std::uint64_t>(v))}});
  std::ofstream(path) << list;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: outputs_sample FOLDER\n";
    return 2;
  }
  const std::string folder = argv[1];
  std::filesystem::create_directories(folder);
  write_numbers(folder + "/numbers.json");
  const auto one = gnomon::compare::make_synthetic(1), three = gnomon::compare::make_synthetic(3),
             none = gnomon::compare::make_synthetic(1), large = gnomon::compare::make_synthetic(1),
             cancelling = gnomon::compare::make_synthetic(1);
  cancel_out(cancelling->comparison.lights[0]);
  gnomon::compare::clear_comparison(none->comparison.lights[0]);
  for (gnomon::raster::LightRecord& record : three->comparison.raster.lights)
    record.unshadowed_pass.runs = {1.0};  // so that the page says what shadows alone cost
  three->scene.lights[1].name = "Point_light_over_the_long_table_001";  // as modelling programs name them
  large->comparison.raster.options.size = {10000, 5625};  // as it says of itself; its images stay small
  return write(one->comparison, folder + "/one") && write(three->comparison, folder + "/three") &&
                 write(none->comparison, folder + "/none") && write(large->comparison, folder + "/large") &&
                 write(cancelling->comparison, folder + "/cancelling") && write_captures(folder + "/captures")
             ? 0
             : 1;
}
