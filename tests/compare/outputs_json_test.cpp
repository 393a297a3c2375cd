// result.json: valid against its schema, and its sums hold. The comparison is the hand-made one.
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "compare/result/outputs.h"
#include "compare/result/result_schema.h"
#include "tests/support/json_schema_check.h"
#include "tests/support/places.h"
#include "tests/support/synthetic_comparison.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::json;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(ResultJson, FitsItsSchemaWithOneAndSeveralLights) {
  for (const int lights : {1, 3}) {
    const auto made = make_synthetic(lights);
    const Json json = Json::parse(result_json(made->comparison));
    EXPECT_EQ(joined(SchemaCheck(result_schema()).violations(json)), "");
    EXPECT_EQ(json["lights"].size(), static_cast<std::size_t>(lights));
  }
}

TEST(ResultJson, NamesTheThresholdThatErrorsWereHeldAgainst) {
  const auto made = make_synthetic();
  EXPECT_FALSE(Json::parse(result_json(made->comparison)).contains("fail_above"));
  for (const double limit : {0.0, 1.0}) {
    made->comparison.fail_above = Threshold{find_measure("mean"), limit};
    const Json json = Json::parse(result_json(made->comparison));
    EXPECT_EQ(joined(SchemaCheck(result_schema()).violations(json)), "");
    EXPECT_EQ(json["fail_above"]["threshold"], limit == 0.0 ? "mean:0%" : "mean:100%");
    EXPECT_EQ(json["fail_above"]["failed"], limit == 0.0);
  }
}

TEST(ResultJson, SchemaRefusesMissingUnknownAndMistypedKeys) {
  const auto made = make_synthetic();
  const Json good = Json::parse(result_json(made->comparison));
  SchemaCheck check(result_schema());
  Json bad = good;
  bad["lights"][0]["error"].erase("wrong");
  EXPECT_EQ(check.violations(bad).size(), 1u);
  bad = good;
  bad["lights"][0]["classes"]["moire"] = 1;
  EXPECT_EQ(check.violations(bad).size(), 1u);
  bad = good;
  bad["lights"][0]["error"]["rms"] = nullptr;
  EXPECT_EQ(check.violations(bad).size(), 1u);
  bad = good;
  bad["lights"][0]["pixels"]["total"] = -1;
  EXPECT_EQ(check.violations(bad).size(), 1u);
}

// A key is required unless the schema says that not every document has it.
TEST(ResultJson, EveryKeyThatIsAlwaysWrittenIsRequired) {
  const auto made = make_synthetic();
  const Json good = Json::parse(result_json(made->comparison));
  SchemaCheck check(result_schema());
  for (const char* path :
       {"/timing", "/machine/load", "/costs/glossy_rays", "/times_ms/upload", "/lights/0/engine_units",
        "/lights/0/derived_bias", "/lights/0/bias_kinds", "/lights/0/lookups", "/lights/0/map/window",
        "/lights/0/map/bias/unit", "/lights/0/map/bias/adaptive", "/lights/0/times_ms/shadow_lookups",
        "/lights/0/best_bias/constant_texels"}) {
    const Json::json_pointer key(path);
    ASSERT_TRUE(good.contains(key)) << path;
    Json bad = good;
    bad[key.parent_pointer()].erase(key.back());
    EXPECT_EQ(check.violations(bad).size(), 1u) << path;
  }
}

TEST(ResultJson, CountsAndBudgetAddUp) {
  const auto made = make_synthetic();
  const Json light = Json::parse(result_json(made->comparison))["lights"][0];
  std::uint64_t classes = 0, pixels = 0;
  std::set<std::string> of_others;  // other renderers' pictures alone have them
  for (std::size_t k = static_cast<std::size_t>(Label::unexplained); k <= class_count; ++k)
    of_others.emplace(label_name(static_cast<Label>(k)));
  for (const auto& [name, count] : light["classes"].items()) {
    if (of_others.contains(name))
      EXPECT_EQ(count.get<std::uint64_t>(), 0u);
    else
      EXPECT_GT(count.get<std::uint64_t>(), 0u) << name << " does not occur in the hand-made comparison";
    classes += count.get<std::uint64_t>();
  }
  EXPECT_EQ(classes, light["error"]["wrong"]);
  double errors = 0.0;
  for (const auto& [name, error] : light["class_errors"].items()) errors += error.get<double>();
  EXPECT_NEAR(errors, light["error"]["mean_absolute"].get<double>(), 1e-12);
  EXPECT_EQ(classes, light["error"]["false_shadow"].get<std::uint64_t>() +
                         light["error"]["missed_shadow"].get<std::uint64_t>());
  for (const char* name : {"background", "facing_away", "silhouette", "uncertain", "compared"})
    pixels += light["pixels"][name].get<std::uint64_t>();
  EXPECT_EQ(pixels, light["pixels"]["total"]);
  double sum = 0.0;
  std::uint64_t false_shadow = 0, missed_shadow = 0;
  for (const Json& step : light["budget"]) {
    sum += step["signed"].get<double>();
    EXPECT_NEAR(step["lightened"].get<double>() - step["darkened"].get<double>(),
                step["signed"].get<double>(), 1e-15);
    EXPECT_NEAR(step["lightened"].get<double>() + step["darkened"].get<double>(),
                step["absolute"].get<double>(), 1e-15);
    EXPECT_GE(step["darkened"].get<double>(), 0.0);
    EXPECT_GE(step["lightened"].get<double>(), 0.0);
    false_shadow += step["false_shadow"].get<std::uint64_t>();
    missed_shadow += step["missed_shadow"].get<std::uint64_t>();
  }
  EXPECT_EQ(false_shadow, light["error"]["false_shadow"]);
  EXPECT_EQ(missed_shadow, light["error"]["missed_shadow"]);
  EXPECT_NEAR(sum, light["ladder"][6]["mean"].get<double>() - light["ladder"][0]["mean"].get<double>(),
              1e-12);
}

TEST(ResultJson, KeepsTheOrderAndNamesOfTheContract) {
  const auto made = make_synthetic();
  const auto json = nlohmann::ordered_json::parse(result_json(made->comparison));
  std::vector<std::string> classes, causes;
  for (const auto& [name, count] : json["lights"][0]["classes"].items()) classes.push_back(name);
  for (const auto& step : json["lights"][0]["budget"]) causes.push_back(step["cause"]);
  EXPECT_EQ(classes, (std::vector<std::string>{
                         "acne",           "precision",     "peter_panning", "light_leak",     "aliasing",
                         "missed_feature", "false_feature", "blur",          "light_size",     "outside_map",
                         "custom_shader",  "unexplained",   "caster_bias",   "missing_caster", "moved_caster",
                         "clipped_caster", "culled_caster", "ignored_alpha", "noise",          "lag",
                         "remap"}));
  EXPECT_EQ(causes,
            (std::vector<std::string>{"light_size", "sampling", "slope", "precision", "bias", "filter"}));
}

TEST(ResultJson, LightsSayWhereTheyAre) {
  const auto made = make_synthetic(2);
  const Json json = Json::parse(result_json(made->comparison));
  EXPECT_TRUE(json["lights"][0]["light"].contains("direction"));
  EXPECT_FALSE(json["lights"][0]["light"].contains("position"));
  EXPECT_EQ(json["lights"][1]["light"]["position"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["lights"][1]["map"]["faces"], 6);
}

TEST(ResultJson, WritesNullForWhatHasNoValue) {
  const auto made = make_synthetic();
  LightComparison& light = made->comparison.lights[0];
  light.best_bias.needs_more_than = -infinity;
  light.best_bias.needs_less_than = infinity;
  made->comparison.raster.lights[0].map_pass.runs.clear();
  const Json json = Json::parse(result_json(made->comparison));
  EXPECT_TRUE(json["lights"][0]["best_bias"]["needs_more_than"].is_null());
  EXPECT_TRUE(json["lights"][0]["best_bias"]["needs_less_than"].is_null());
  EXPECT_TRUE(json["lights"][0]["times_ms"]["map_pass"]["median"].is_null());
  EXPECT_EQ(joined(SchemaCheck(result_schema()).violations(json)), "");
  light.error.rms = std::nan("");  // has no meaning there: the schema must refuse what is written for it
  EXPECT_EQ(SchemaCheck(result_schema()).violations(Json::parse(result_json(made->comparison))).size(), 1u);
}

TEST(ResultJson, SurvivesNamesThatAreNotUtf8) {
  const auto made = make_synthetic();
  made->scene.name = "bad \xff\xc0 name \"quoted\"\n";
  const Json json = Json::parse(result_json(made->comparison));
  EXPECT_NE(json["scene"]["name"].get<std::string>().find("quoted"), std::string::npos);
}

}  // namespace
}  // namespace gnomon::compare
