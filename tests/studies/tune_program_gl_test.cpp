// gnomon tune as a process: its answer is a command that keeps the promise, or the reason why there is none.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program_process.h"

namespace gnomon::test {
namespace {

class TuneProgram : public SweepProgram {};

TEST_F(TuneProgram, AnswersWithACommandThatKeepsItsPromise) {
  const std::string json = (root / "answer.json").string();
  ASSERT_EQ(run({"tune", "floating-box", "--technique", "hard", "--size", "160x90", "--max-error", "2%",
                 "--map-size", "32:512:x2", "--runs", "1", "--json", json}),
            0)
      << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  EXPECT_TRUE(answer["feasible"]);
  EXPECT_LE(answer["error"].get<double>(), 0.02);
  EXPECT_GE(answer["others"].size(), 4u);
  EXPECT_LE(answer["renders"].get<int>(), 3 * 6 + 1);  // a grid: 5 sizes, 6 kinds of bias, every bias

  // The same figures from compare itself.
  Words words{"compare", "floating-box", "-o", (root / "tuned").string()};
  for (const auto& [name, value] : answer["options"].items()) {
    if (value == "off") continue;
    words.push_back("--" + name);
    if (value != "on") words.push_back(value);
  }
  ASSERT_EQ(run(words), 0) << said();
  const nlohmann::json result = nlohmann::json::parse(bytes_of(root / "tuned/result.json"));
  EXPECT_EQ(result["lights"][0]["error"]["wrong_fraction"], answer["error"]);
  EXPECT_NE(answer["command"].get<std::string>().find("gnomon compare floating-box"), std::string::npos);
}

// Of a light with size a pixel's truth is a share: what the tuner promises is what compare finds.
TEST_F(TuneProgram, KeepsItsWordForLightsWithSize) {
  const std::string json = (root / "answer.json").string();
  ASSERT_EQ(run({"tune", "penumbra", "--technique", "hard", "--size", "160x90", "--max-error", "mean:5%",
                 "--map-size", "128,256,512", "--runs", "1", "--json", json}),
            0)
      << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  EXPECT_EQ(answer["goal"]["threshold"], "mean:5%");
  Words words{"compare", "penumbra", "-o", (root / "tuned").string(), "--fail-above", "mean:5%"};
  for (const auto& [name, value] : answer["options"].items()) {
    if (value == "off") continue;
    words.push_back("--" + name);
    if (value != "on") words.push_back(value);
  }
  ASSERT_EQ(run(words), 0) << said();
  const nlohmann::json error =
      nlohmann::json::parse(bytes_of(root / "tuned/result.json"))["lights"][0]["error"];
  EXPECT_EQ(error["mean_absolute"], answer["error"]);
  EXPECT_EQ(error["wrong_fraction"], answer["wrong_fraction"]);
  EXPECT_NE(error["wrong_fraction"], error["mean_absolute"]);
}

// Under a drift an unsnapped map flips at every size: only what is snapped is good enough, and the command says so.
TEST_F(TuneProgram, FindsWhatHoldsStill) {
  const std::string json = (root / "answer.json").string();
  ASSERT_EQ(run({"tune",        "thin-wall",
                 "--technique", "hard",
                 "--size",      "192x108",
                 "--max-error", "shimmer:0",
                 "--map-size",  "64,128",
                 "--runs",      "1",
                 "--frames",    "4",
                 "--path",      "drift",
                 "--drift",     "0.5,0.5",
                 "--json",      json,
                 "-o",          (root / "page").string()}),
            0)
      << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  EXPECT_EQ(answer["goal"]["measure"], "shimmer");
  EXPECT_EQ(answer["options"]["snap"], "on");
  EXPECT_EQ(answer["error"], 0.0);
  ASSERT_EQ(answer["others"].size(), 1u);
  EXPECT_GT(answer["others"][0]["error"].get<double>(), 0.0);
  EXPECT_NE(bytes_of(root / "page/report.html").find("flips per receiver and second"), std::string::npos);
  // Both families' own commands give what was said of them.
  for (const nlohmann::json* family : {&answer, &answer["others"][0]}) {
    std::istringstream command((*family)["command"].get<std::string>());
    Words words;
    for (std::string word; command >> word;) words.push_back(word);
    ASSERT_EQ(words.at(0) + words.at(1), "gnomonshimmer");
    words.erase(words.begin());
    words.insert(words.end(),
                 {"--quiet", "--json", (root / "film.json").string(), "-o", (root / "film").string()});
    ASSERT_EQ(run(words), 0) << said();
    const nlohmann::json film = nlohmann::json::parse(bytes_of(root / "film.json"));
    EXPECT_EQ(film["lights"][0]["flips_per_receiver_second"], (*family)["error"]);
  }
}

// Of one engine only what it draws is tried (not pcss, which is the hard test under a light without size), and the answer names its settings alone; what the time did not suffice for is
// named, too.
TEST_F(TuneProgram, AsksForOneEngineAndWithinATime) {
  const std::string json = (root / "answer.json").string();
  const Words asked{"tune",       "floating-box", "--size", "96x54",  "--max-error", "5%",       "--map-size",
                    "64,128,256", "--runs",       "1",      "--json", json,          "--engine", "godot"};
  ASSERT_EQ(run(asked), 0) << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  for (const auto& family : answer["others"])
    EXPECT_TRUE(family["technique"] == "hard" || family["technique"] == "pcf" || family["technique"] == "csm")
        << family["command"];
  EXPECT_NE(said().find("shadow_normal_bias"), std::string::npos) << said();
  EXPECT_EQ(said().find("three.js"), std::string::npos) << said();
  const std::string_view setting = "\n  shadow_bias ";
  EXPECT_EQ(said().find(setting), said().rfind(setting)) << "one answer: " << said();
  EXPECT_GT(answer["engine_units"][0]["derived_bias"]["constant_texels"], 1.0 / 16.0);
  EXPECT_EQ(answer["untried"].size(), 0u);
  const std::string text = said();
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 20);  // with the lines of progress

  Words hurried = asked;
  hurried.insert(hurried.end(), {"--time-limit", "1e-9"});
  ASSERT_EQ(run(hurried), 0) << said();
  const nlohmann::json first = nlohmann::json::parse(bytes_of(json));
  EXPECT_EQ(first["others"].size(), 0u);
  EXPECT_EQ(first["untried"].size(), answer["others"].size());
  EXPECT_NE(said().find("Not tried within 1e-09 s"), std::string::npos) << said();
  EXPECT_EQ(run({"tune", "floating-box", "--max-error", "5%", "--engine", "quake"}), 2);
}

// The first setting that will do ends the search, and it keeps its promise, too.
TEST_F(TuneProgram, EndsQuicklyWithTheFirstThatIsGoodEnough) {
  const std::string json = (root / "answer.json").string();
  const Words asked{"tune",       "floating-box", "--size", "96x54", "--max-error", "5%",
                    "--map-size", "64,128,256",   "--runs", "1",     "--json",      json};
  ASSERT_EQ(run(asked), 0) << said();
  const nlohmann::json whole = nlohmann::json::parse(bytes_of(json));
  Words quickly = asked;
  quickly.emplace_back("--quick");
  ASSERT_EQ(run(quickly), 0) << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  EXPECT_LE(answer["error"].get<double>(), 0.05);
  EXPECT_LT(answer["renders"].get<int>(), whole["renders"].get<int>() / 2);
  EXPECT_NE(answer["why"].get<std::string>().find("the first that is good enough"), std::string::npos)
      << answer["why"];
  EXPECT_GT(answer["untried"].size(), 0u);
  EXPECT_NE(said().find("(--quick)"), std::string::npos) << said();
  EXPECT_EQ(run({"tune", "floating-box", "--max-time", "5", "--quick"}), 2);
}

// PlayCanvas has no constant: its polygon offset and its normal offset alone are tried, and the command draws what was promised.
TEST_F(TuneProgram, AsksAnEngineOnlyForWhatItCanBeTold) {
  const std::string json = (root / "answer.json").string();
  const Words asked{"tune",    "floating-box", "--size", "96x54",  "--max-error", "5%",       "--map-size",
                    "256,512", "--runs",       "1",      "--json", json,          "--engine", "playcanvas"};
  ASSERT_EQ(run(asked), 0) << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  std::vector<nlohmann::json> families(answer["others"].begin(), answer["others"].end());
  families.push_back(answer);
  for (const nlohmann::json& family : families) {
    const nlohmann::json& options = family["options"];
    EXPECT_EQ(options["bias"], "0") << family["command"];
    EXPECT_TRUE(options.contains("caster-slope-bias") || options.contains("normal-offset"))
        << family["command"];
    EXPECT_TRUE(family["technique"] != "pcf" || options["filter-plane"] == "off") << family["command"];
  }
  EXPECT_NE(said().find("In PlayCanvas"), std::string::npos) << said();
  EXPECT_EQ(said().find("no number"), std::string::npos) << said();
  // Of a point light no constant of Unity's is known as a number.
  EXPECT_EQ(run({"tune", "penumbra", "--max-error", "5%", "--engine", "unity"}), 2);
  EXPECT_NE(said().find("--engine unity: of a point light"), std::string::npos) << said();
}

// One page to print: the answer and its rivals, each with its worst place beside the truth, its figures and its settings.
TEST_F(TuneProgram, WritesASheetToPrint) {
  const std::string out = (root / "tuned").string();
  ASSERT_EQ(run({"tune", "floating-box", "--technique", "hard,pcf", "--size", "96x54", "--max-error", "2%",
                 "--map-size", "64:256:x2", "--runs", "3", "--engine", "godot", "-o", out}),
            0)
      << said();
  const std::string sheet = bytes_of(out + "/sheet.html"), mark = "id=\"result\">";
  const std::size_t start = sheet.find(mark) + mark.size();
  const nlohmann::json document =
      nlohmann::json::parse(sheet.substr(start, sheet.find("</script>", start) - start));
  ASSERT_EQ(document["candidates"].size(), 2u);
  for (const auto& candidate : document["candidates"]) {
    const std::string rows = candidate["rows"].dump();
    for (const char* part :
         {"of the truth is open", "flips per receiver and second", "median of 3", "taps", "texels drawn"})
      EXPECT_NE(rows.find(part), std::string::npos) << part << " in " << rows;
    EXPECT_TRUE(candidate["command"].get<std::string>().starts_with("gnomon compare floating-box"));
    ASSERT_FALSE(candidate["units"].empty());
    for (const auto& unit : candidate["units"]) EXPECT_EQ(unit["engine"], "Godot");
  }
  for (const char* name : {"drawn-0", "truth-0", "drawn-1", "truth-1"})
    EXPECT_NE(sheet.find(std::string("data-picture=\"") + name), std::string::npos) << name;
  const nlohmann::json result = nlohmann::json::parse(bytes_of(out + "/result.json"));
  EXPECT_FALSE(result["lights"][0].contains("shimmer")) << "the page is of the answer alone";
}

TEST_F(TuneProgram, SaysWhyNothingCanWork) {
  const std::string json = (root / "answer.json").string();
  EXPECT_EQ(run({"tune", "floating-box", "--size", "160x90", "--max-error", "0", "--map-size", "16,32",
                 "--runs", "1", "--technique", "hard", "--slope-bias", "0", "--json", json}),
            1)
      << said();
  const nlohmann::json answer = nlohmann::json::parse(bytes_of(json));
  EXPECT_FALSE(answer["feasible"]);
  EXPECT_NE(answer["why"].get<std::string>().find("no constant bias fits all: "), std::string::npos)
      << answer["why"];
  EXPECT_EQ(run({"tune", "floating-box"}), 2);
  EXPECT_EQ(run({"tune", "floating-box", "--max-error", "1%", "--max-time", "5"}), 2);
  EXPECT_EQ(run({"tune", "floating-box", "--max-error", "1%", "--bias", "0"}), 2);
}

}  // namespace
}  // namespace gnomon::test
