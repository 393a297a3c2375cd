// The table of figures: a row is all that result.json, CSV and its schema's check ask for, each row stands for a field of its
// own, and several lights are pooled as its row says.
#include "compare/result/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/result_schema.h"
#include "compare/result/threshold.h"
#include "tests/support/places.h"
#include "tests/support/synthetic_comparison.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::json;

std::string pointer_to(std::string_view key, std::string_view between) {
  std::string pointer = std::string(between) + std::string(key);
  for (std::size_t at = 0; (at = pointer.find('.', at)) != std::string::npos;)
    pointer.replace(at, 1, between);
  return pointer;
}

// What is said of a number stands in its row, and every row's block in the schema's frame.
TEST(Figures, TheSchemaHasEachWithItsTypeAndWords) {
  const Json light = result_schema()["$defs"]["light"];
  for (const Figure& figure : figures()) {
    const Json::json_pointer place(pointer_to(figure.key, "/properties/"));
    ASSERT_TRUE(light.contains(place)) << figure.key;
    const std::string type = light[place]["type"].dump();
    EXPECT_NE(type.find(figure.form() == FigureForm::count ? "integer" : "number"), std::string::npos)
        << figure.key << ": " << type;
    EXPECT_GT(light[place]["description"].dump().size(), 2u) << figure.key;
  }
}

TEST(Figures, ResultJsonAndCsvHaveEach) {
  const auto made = make_synthetic();
  made->comparison.raster.options.map.technique = raster::Technique::vsm;
  LightComparison& light = made->comparison.lights[0];
  light.penumbra.emplace(), light.seams.emplace(), light.shimmer.emplace(), light.bleeding.emplace();
  made->comparison.raster.lights[light.record].unshadowed_pass.runs = {25.0, 24.0, 26.0};
  const Json json = Json::parse(result_json(made->comparison))["lights"][0];
  const std::string csv = result_csv(made->comparison), head = "," + csv.substr(0, csv.find('\r')) + ",";
  for (const Figure& figure : figures()) {
    EXPECT_TRUE(json.contains(Json::json_pointer(pointer_to(figure.key, "/")))) << figure.key;
    EXPECT_NE(head.find("," + pointer_to(figure.key, "_").substr(1) + ","), std::string::npos) << figure.key;
  }
}

TEST(Figures, ARangeNamesEveryMeasureThatAThresholdMayBe) {
  for (const Figure& figure : figures()) {
    if (figure.measure.name.empty()) continue;
    const std::string said = std::string(figure.measure.name) + ":";
    EXPECT_NE(threshold_range(true).find(said), std::string::npos) << said;
    EXPECT_EQ(threshold_range(false).find(said) == std::string::npos, figure.needs == FigureNeeds::film)
        << said;
    EXPECT_FALSE(figure.measure.example.empty()) << said;
  }
}

TEST(Figures, ARowSetsItsOwnFieldAlone) {
  std::vector<const Figure*> settable;
  for (const Figure& figure : figures())
    if (figure.place.set != nullptr) settable.push_back(&figure);
  for (const Figure* changed : settable) {
    LightFigures light;
    for (const Figure* figure : settable) figure->place.set(light, 3.0);
    changed->place.set(light, 7.0);
    for (const Figure* figure : settable)
      EXPECT_EQ(figure->of(light), figure == changed ? 7.0 : 3.0) << changed->key << ", " << figure->key;
  }
}

TEST(Figures, AllLightsTogetherAreSummedAndWeighed) {
  std::vector<LightFigures> lights(2);
  lights[0].pixels.compared = 300, lights[0].error.wrong = 10, lights[0].error.ties = 2;
  lights[1].pixels.compared = 100, lights[1].error.wrong = 30;
  lights[0].error.mean_absolute = 0.1, lights[1].error.mean_absolute = 0.5;
  lights[0].error.rms = 0.2, lights[1].error.rms = 0.6;
  lights[0].edges = {10, 0.0, 4.0}, lights[1].edges = {30, 0.0, 2.0};
  lights[0].shimmer = ShimmerFigures{2, 30.0, 1000, 10, 0.3}, lights[1].shimmer = {2, 30.0, 500, 20, 1.2};
  const LightFigures pooled = pool_lights(lights);
  EXPECT_EQ(pooled.pixels.compared, 400u);
  EXPECT_DOUBLE_EQ(pooled.error.wrong_fraction, 41.0 / 400.0) << "two ties are one wrong pixel";
  EXPECT_DOUBLE_EQ(pooled.error.mean_absolute, 0.2);
  EXPECT_DOUBLE_EQ(pooled.error.rms, std::sqrt((3.0 * 0.04 + 0.36) / 4.0));
  EXPECT_TRUE(std::isnan(pooled.error.flip)) << "of no light computed";
  EXPECT_DOUBLE_EQ(pooled.edges.rms_texels, std::sqrt((10.0 * 16.0 + 30.0 * 4.0) / 40.0));
  EXPECT_DOUBLE_EQ(pooled.shimmer->flips_per_receiver_second, 30.0 * 30.0 / 1500.0);
  lights[0].shimmer.reset(), lights[1].shimmer.reset();
  EXPECT_FALSE(pool_lights(lights).shimmer.has_value());
}

TEST(Figures, EachThatAThresholdNamesIsSaidInWordsWithItsValue) {
  for (const Figure& figure : figures()) {
    if (figure.measure.name.empty()) continue;
    EXPECT_EQ(find_measure(figure.measure.name), &figure);
    for (const std::string_view words : {figure.measure.said, figure.measure.limit, figure.measure.level})
      EXPECT_NE(words.find("{}"), std::string_view::npos) << figure.key;
  }
  EXPECT_EQ(find_measure(""), nullptr);
  EXPECT_EQ(find_measure("wrong and mean"), nullptr) << "a plain number";
}

}  // namespace
}  // namespace gnomon::compare
