// The words: summary, CSV, numbers and file names.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "compare/ladder/budget.h"
#include "compare/measure/reduced.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/shadow_cost.h"
#include "compare/result/text_layout.h"
#include "compare/result/verdict.h"
#include "report/html.h"
#include "report/lessons.h"
#include "report/shell.h"
#include "report/write_outputs.h"
#include "studies/sweep/summary.h"
#include "tests/support/synthetic_comparison.h"

namespace gnomon::compare {
namespace {

TEST(NumberText, WritesCountsSharesAndTimes) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(1086177), "1,086,177");
  EXPECT_EQ(percent(0.0), "0 %");
  EXPECT_EQ(percent(0.0412), "4.1 %");
  EXPECT_EQ(percent(0.006), "0.6 %");
  EXPECT_EQ(percent(0.4361), "43.6 %");
  EXPECT_EQ(percent(0.01), "1.0 %");
  EXPECT_EQ(percent(0.99), "99.0 %");
  EXPECT_EQ(percent(1.0), "100 %");
  EXPECT_EQ(percent(1e-9), "less than 0.001 %");
  EXPECT_EQ(percent(0.99996), "more than 99.99 %");
  EXPECT_EQ(signed_number(-0.04171), "\u22120.0417");
  EXPECT_EQ(signed_number(0.0), "0");
  EXPECT_EQ(unsigned_number(0.0163), "0.0163");
  EXPECT_EQ(signed_number(2e-5), "+0.00002");
  EXPECT_EQ(milliseconds(0.423), "0.42 ms");
  EXPECT_EQ(milliseconds(95.25), "95 ms");
  EXPECT_EQ(milliseconds(1904.0), "1.9 s");
  EXPECT_EQ(milliseconds(999600.0), "1000 s");
  EXPECT_EQ(milliseconds(3723000.0), "3723 s");
  EXPECT_EQ(milliseconds(-1.0), "not timed");
  EXPECT_EQ(plain_number(999.4), "999");
  EXPECT_EQ(plain_number(-999.7), "-1000");
  EXPECT_EQ(byte_count(999700000), "1 GB");
  EXPECT_EQ(byte_count(16777216), "16.8 MB");
  EXPECT_EQ(texels_text(0.8), "0.8 texel");
  EXPECT_EQ(texels_text(1.0), "1 texel");
  EXPECT_EQ(texels_text(1.56), "1.6 texels");
  EXPECT_EQ(texels_text(149.6), "150 texels");
  EXPECT_EQ(texels_text(1e-5), "less than 0.001 texel");
  EXPECT_EQ(texels_text(-1.0, 3), "-1 texel");
  EXPECT_EQ(texels_text(1.5625, 3), "1.56 texels");
  EXPECT_EQ(texels_text(0.9999, 3), "1 texel");
}

TEST(Text, NounsFollowTheNumberThatIsPrinted) {
  EXPECT_EQ(with_noun("1", "world unit"), "1 world unit");
  EXPECT_EQ(with_noun("0.04", "world unit"), "0.04 world units");
  EXPECT_EQ(counted(0, "ray"), "0 rays");
  EXPECT_EQ(counted(1, "drawing"), "1 drawing");
  EXPECT_EQ(counted(1024, "triangle"), "1,024 triangles");
}

// What is promised to hold something is not smaller than it.
TEST(Text, PromisedSizesAreRoundedUp) {
  EXPECT_EQ(plain_number_up(16.12), "16.2");
  EXPECT_EQ(plain_number_up(16.1), "16.1");
  EXPECT_EQ(plain_number_up(1234.2), "1235");
  EXPECT_EQ(plain_number_up(0.09991), "0.1");
  EXPECT_EQ(plain_number_up(0.0), "0");
  for (double value = 1.2345e-7; value < 1e9; value *= 1.37) {
    const double up = std::stod(plain_number_up(value));
    EXPECT_GE(up, value);
    EXPECT_LE(up, 1.01 * value) << value;
  }
}

TEST(Csv, NamesAreNoFormulas) {
  EXPECT_EQ(csv_name("=HYPERLINK(A1)"), "'=HYPERLINK(A1)");
  EXPECT_EQ(csv_name("+cmd"), "'+cmd");
  EXPECT_EQ(csv_name("-sun"), "'-sun");
  EXPECT_EQ(csv_name("@sum"), "'@sum");
  EXPECT_EQ(csv_name("\tsun"), "'\tsun");
  EXPECT_EQ(csv_name("sun = 1"), "sun = 1");
  EXPECT_EQ(csv_name("-1.5,2e-3,+4"), "-1.5,2e-3,+4");  // a camera's place
  EXPECT_EQ(csv_name(""), "");
  const auto made = make_synthetic();
  const_cast<Scene*>(made->comparison.world->scene)->lights[0].name = "=1+1,\"x\"";
  EXPECT_NE(result_csv(made->comparison).find(",\"'=1+1,\"\"x\"\"\","), std::string::npos);
}

// 1.6 % of them are wrong as drawn.
// The first screen's large letters say what is wrong and what would help; why nothing is right everywhere stands below.
// A page holds 8,388,608 pixels.
// Browsers break lines at hyphens.
TEST(Html, KeepsOptionsAndNumbersTogether) {
  EXPECT_EQ(report::flowing("A bias (--slope-bias 1) would leave 4.3 % <all>"),
            "A bias (<span class=\"option\">--slope-bias</span> 1) would leave 4.3\u00a0% &lt;all&gt;");
  EXPECT_EQ(report::flowing("--snap"), "<span class=\"option\">--snap</span>");
  EXPECT_EQ(report::flowing("one -- two --- --2-"), "one -- two --- --2-");
}

TEST(Page, ShowsEveryPixelWhereItHoldsThemAll) {
  EXPECT_EQ(image_step({4096, 2048}), 1);
  EXPECT_EQ(image_step({4097, 2048}), 2);
  EXPECT_EQ(image_step({8192, 4096}), 2);
  EXPECT_EQ(image_step({8193, 4096}), 3);
  EXPECT_EQ(image_step({16384, 16384}), 6);
}

TEST(Repeats, StopWhereTheRunsMadeTookLongEnough) {
  EXPECT_TRUE(times_again({}, 3, 0.0)) << "the first is always made";
  EXPECT_TRUE(times_again({{10.0, 10.0}}, 3, 25.0));
  EXPECT_FALSE(times_again({{30.0}}, 3, 25.0));
  EXPECT_FALSE(times_again({{1.0, 1.0, 1.0}}, 3, 25.0));
  EXPECT_TRUE(times_again({{30.0}}, 3, 25.0, 3)) << "what is subtracted is run so often whatever it takes";
  EXPECT_FALSE(times_again({{30.0}}, 1, 25.0, 3)) << "no more than was asked for";
}

TEST(ShadowCost, IsWhatIsLeftRunByRun) {
  raster::LightRecord drawn;
  drawn.shade_pass.runs = {10.0, 12.0};
  EXPECT_FALSE(shadow_lookups(drawn).timed());
  drawn.unshadowed_pass.runs = {8.0, 13.0};
  EXPECT_EQ(shadow_lookups(drawn).pairs.runs, (std::vector<double>{2.0, -1.0}));
  raytrace::LightTruth truth;
  truth.shadow_rays.runs = {9.0};
  truth.light_structure.runs = {4.0};
  EXPECT_EQ(standing_rays(truth).runs, (std::vector<double>{5.0}));
}

ShadowParts parts_of(double map, double lookups, double rays, double tree) {
  const auto told = [](double ms) { return with_spread({{ms, ms, ms}}); };
  return {.map = told(map), .lookups = told(lookups), .rays = told(rays), .tree = told(tree)};
}

TEST(ShadowCost, EachSideMakesWhatHasMoved) {
  const auto costs = shadow_costs(parts_of(107.0, 8.0, 23.0, 41.0));
  ASSERT_TRUE(costs);
  EXPECT_EQ(shadow_cost_lines(*costs, "map"),
            (std::vector<std::string>{"nothing moves: 8 ms by the map, 23 ms by rays",
                                      "light or camera moves: 115 ms by the map, 23 ms by rays",
                                      "casters move: 115 ms by the map, 64 ms by rays"}));
}

TEST(ShadowCost, TheHybridAsksTheTreeToo) {
  ShadowParts parts = parts_of(5.0, 4.0, 23.0, 41.0);
  parts.by = "hybrid";
  EXPECT_EQ(shadow_cost_lines(*shadow_costs(parts), parts.by).back(),
            "casters move: 50 ms by the hybrid, 64 ms by rays");
}

TEST(ShadowCost, SpreadsAddUpAndLightsShareTheTree) {
  ShadowParts parts = parts_of(10.0, 1.0, 20.0, 40.0);
  parts.rays = with_spread({{20.0, 21.0, 22.0}}), parts.tree = with_spread({{40.0}});
  const auto one = shadow_costs(parts);
  EXPECT_EQ(one->casters_move.rays.low, 18.0 + 30.0);
  EXPECT_EQ(one->casters_move.rays.median, 21.0 + 40.0);
  EXPECT_EQ(one->casters_move.rays.high, 24.0 + 50.0);
  parts += parts_of(10.0, 1.0, 5.0, 40.0);
  EXPECT_EQ(shadow_costs(parts)->casters_move.rays.median, 21.0 + 5.0 + 40.0);
  EXPECT_EQ(shadow_costs(parts)->casters_move.map.median, 22.0);
}

TEST(ShadowCost, WithoutATreesTimeThatOfMovingCastersIsNotTimed) {
  ShadowParts parts = parts_of(10.0, 1.0, 20.0, 40.0);
  parts.tree = {};
  EXPECT_EQ(shadow_cost_lines(*shadow_costs(parts), "map").back(),
            "casters move: 11 ms by the map, not timed by rays");
  parts.lookups = {};
  EXPECT_FALSE(shadow_costs(parts));
}

// A filter as wide as a shadow's stripes leaves grey: nothing is wrong by more than one half, and nothing
// right.
TEST(Threshold, IsHeldAgainstItsOwnFigure) {
  LightFigures grey;
  grey.pixels.compared = 5000, grey.error.mean_absolute = 0.35, grey.error.flip = 0.2;
  grey.edges.rms_texels = 1.5;
  const auto fails = [&grey](const Figure* measure, double limit) {
    return exceeds({measure, limit}, grey) || too_uncertain({measure, limit}, grey);
  };
  EXPECT_FALSE(fails(find_measure("wrong"), 0.0));
  EXPECT_TRUE(fails(&wrong_and_mean(), 0.34));
  EXPECT_FALSE(fails(&wrong_and_mean(), 0.35));
  EXPECT_TRUE(fails(find_measure("mean"), 0.1));
  EXPECT_TRUE(fails(find_measure("flip"), 0.1));
  EXPECT_FALSE(fails(find_measure("edge"), 1.5));
  EXPECT_TRUE(fails(find_measure("edge"), 1.4));
  grey.pixels.uncertain = 5000, grey.pixels.uncertain_by_samples = 4000;
  EXPECT_TRUE(fails(find_measure("wrong"), 0.4)) << "half of the pixels may be wrong";
  EXPECT_FALSE(fails(find_measure("mean"), 0.4)) << "the visibility of all but a tenth is known";
  EXPECT_TRUE(fails(find_measure("mean"), 0.09));
  grey.error.flip = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(fails(find_measure("flip"), 1.0)) << "not computed is not passed";
}

// It has nothing that could be wrong; lights that all have nothing keep no limit.
TEST(Threshold, OneOfSeveralLightsMayFaceAwayFromAllThatIsSeen) {
  const Threshold limit{find_measure("wrong"), 0.01};
  const LightFigures nothing;
  LightFigures right, wrong, open;
  right.pixels.compared = wrong.pixels.compared = 100, wrong.error.wrong_fraction = 0.5;
  open.pixels.uncertain = 5;
  const auto kept = [&](const std::vector<LightFigures>& lights) { return is_kept(limit, lights); };
  EXPECT_TRUE(kept({right}));
  EXPECT_TRUE(kept({right, nothing}));
  EXPECT_FALSE(kept({right, nothing, wrong}));
  EXPECT_FALSE(kept({nothing, nothing}));
  EXPECT_FALSE(kept({open}));
  EXPECT_FALSE(says_nothing(limit, std::vector{open}));
}

TEST(Summary, FitsEightyColumnsAndColoursOnlyWhenAsked) {
  const auto made = make_synthetic(3);
  made->scene.lights[1].name =
      "a light with a name that is far longer than anybody would want it to be, on two\nlines";
  const std::string plain = summary_table(made->comparison, false),
                    coloured = summary_table(made->comparison, true);
  EXPECT_EQ(plain.find('\x1b'), std::string::npos);
  EXPECT_NE(coloured.find('\x1b'), std::string::npos);
  EXPECT_EQ(std::regex_replace(coloured, std::regex("\x1b\\[[0-9;]*m"), ""), plain);
  std::size_t start = 0;
  for (std::size_t end; (end = plain.find('\n', start)) != std::string::npos; start = end + 1)
    EXPECT_LE(text_width(plain.substr(start, end - start)), 80u) << plain.substr(start, end - start);
  for (const char* part :
       {"the map: 12 ms", "exact shadows: 95 ms for 41,234 rays", "acne", "budget", "peak memory 188 MB"})
    EXPECT_NE(plain.find(part), std::string::npos) << part << "\n" << plain;
}

// What a reader has ten seconds for: what is wrong and what to do, of each light one line where there are several; at the end
// where the report is. The rest is asked for.
TEST(Summary, BeginsWithVerdictAndAdviceAndEndsWithThePlace) {
  const auto made = make_synthetic();
  made->comparison.lights.resize(1);
  const Verdict verdict = verdict_on(made->comparison, made->comparison.lights[0]);
  const std::string text = verdict_in_short(made->comparison, false) +
                           figures_in_short(made->comparison, "Report: out/report.html", false);
  std::string expected;
  for (const std::string& sentence : {joined_sentences({verdict.error, verdict.uncertain}), verdict.advice})
    if (!sentence.empty())
      for (const std::string& line : wrapped(sentence, 80)) expected += line + "\n";
  EXPECT_EQ(text.substr(0, expected.size()), expected);
  EXPECT_TRUE(text.ends_with("\n\nReport: out/report.html\n")) << text;
  EXPECT_NE(text.find("\n  labels    "), std::string::npos) << text;
  EXPECT_NE(text.find("\n  time      "), std::string::npos) << text;
  EXPECT_EQ(text.find("\n  theory    "), std::string::npos) << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 20) << text;  // with nearly every label there is
}

/// Steps that cancel out but for what adding them up leaves.
void cancel_out(LightComparison& light) {
  light.budget = {};
  light.budget[1] = {.signed_mean = 0.1, .absolute_mean = 0.3};
  light.budget[4] = {.signed_mean = 0.2, .absolute_mean = 0.2};
  light.budget[5] = {.signed_mean = -0.3, .absolute_mean = 0.3};
  light.rung_mean.fill(0.3);
  light.rung_mean.back() = 0.1 + 0.2;
}

TEST(Summary, WritesNoFigureForTheRoundingOfSums) {
  const auto made = make_synthetic();
  LightComparison& light = made->comparison.lights[0];
  cancel_out(light);
  EXPECT_NE(light.rung_mean.back(), light.rung_mean.front());
  EXPECT_NE(summary_table(made->comparison, false).find("sum 0\n"), std::string::npos)
      << summary_table(made->comparison, false);
  light.budget[5].signed_mean = -0.3 - 2e-9;  // half of a pixel of the largest picture
  EXPECT_NE(summary_table(made->comparison, false).find("\u22120.000000002\n"), std::string::npos)
      << summary_table(made->comparison, false);
}

TEST(Summary, NoStepIsTheRoundingOfItsOwnSum) {
  EXPECT_EQ(beyond_rounding(1e-17, 0.25), 0.0);
  EXPECT_EQ(beyond_rounding(-3e-12, 1.0), 0.0);
  EXPECT_EQ(beyond_rounding(-1e-9, 1.0), -1e-9);
  EXPECT_EQ(beyond_rounding(1e-17, 1e-17), 1e-17);
  EXPECT_EQ(beyond_rounding(0.0, 0.0), 0.0);
}

TEST(TextLayout, WrapsAtSpacesAndCutsLongWords) {
  EXPECT_EQ(wrapped("one two three", 7), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrapped("abcdefghij kl", 4), (std::vector<std::string>{"abcd", "efgh", "ij", "kl"}));
  EXPECT_EQ(wrapped("in 95 ms", 5), (std::vector<std::string>{"in", "95 ms"}));
  EXPECT_EQ(wrapped("", 4), std::vector<std::string>{""});
  EXPECT_EQ(text_width("\u2212\u00e41"), 3u);
}

TEST(Csv, HasOneRowPerLightAndQuotesNames) {
  const auto made = make_synthetic(2);
  made->scene.name = "a \"b\", c";
  const std::string csv = result_csv(made->comparison);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_NE(csv.find("\r\n\"a \"\"b\"\", c\",sun,directional,320,180,hard,64,"), std::string::npos) << csv;
  const std::string header = csv.substr(0, csv.find('\r'));
  EXPECT_EQ(header.rfind("scene_name,light,light_type,size_width,size_height,map_technique,map_size,", 0),
            0u);
  for (const char* column : {"error_wrong_fraction", "error_mean_absolute", "edges_rms_texels",
                             "times_ms_map_pass_median", "times_ms_primary_rays_median"})
    EXPECT_NE(("," + header + ",").find(std::string(1, ',') + column + ","), std::string::npos) << column;
  const std::string row =
      csv.substr(csv.find(",sun,"), csv.find('\r', csv.find(",sun,")) - csv.find(",sun,"));
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
}

TEST(FileNames, KeepLightsApart) {
  const auto one = make_synthetic(1), two = make_synthetic(2), three = make_synthetic(3);
  EXPECT_EQ(aov_path(one->comparison, one->comparison.lights[0], "d.x/aov.exr"), "d.x/aov.exr");
  EXPECT_EQ(aov_path(two->comparison, two->comparison.lights[1], "d.x/aov.exr"), "d.x/aov-lamp-2.exr");
  EXPECT_EQ(aov_path(two->comparison, two->comparison.lights[0], "d.x/aov"), "d.x/aov-sun");
  EXPECT_EQ(light_file_part(three->comparison, three->comparison.lights[1]), "lamp-2-1");
  EXPECT_EQ(light_file_part(three->comparison, three->comparison.lights[2]), "lamp-2-2");
  // A name of which nothing is left gets a number, which must not make it another light's.
  two->scene.lights[0].name = "light-1", two->scene.lights[1].name = "\u592a\u967d";
  EXPECT_EQ(light_file_part(two->comparison, two->comparison.lights[0]), "light-1-0");
  EXPECT_EQ(light_file_part(two->comparison, two->comparison.lights[1]), "light-1");
}

// A light without edges says nothing of how far edges lie off.
TEST(CellSummary, WeighsEdgesByTheirNumber) {
  const auto made = make_synthetic(3);
  std::vector<LightComparison>& lights = made->comparison.lights;
  lights[0].edges = {10, 0.0, 4.0, 4.0}, lights[1].edges = {}, lights[2].edges = {30, 0.0, 2.0, 2.0};
  const auto cell = studies::summarise(result_line(made->comparison, {{"map_size", "64"}}),
                                       on_one_line(cell_times_json(made->comparison, 0, {.ms = 1.0})));
  ASSERT_TRUE(cell) << cell.error().message();
  EXPECT_EQ(cell->figures.edges.edges, 40u);
  EXPECT_NEAR(cell->figures.edges.rms_texels, std::sqrt((10.0 * 16.0 + 30.0 * 4.0) / 40.0), 1e-12);
}

TEST(Lessons, EachIsTitledAndBeginsWithWordsAndACommand) {
  ASSERT_EQ(report::all_lessons().size(), 26u);
  for (const report::Lesson& one : report::all_lessons()) {
    EXPECT_FALSE(one.title.empty()) << one.name;
    EXPECT_TRUE(one.command.starts_with("gnomon ")) << one.name << ": " << one.command;
    const std::string html = report::lesson_html(one);
    EXPECT_TRUE(html.starts_with("<p>")) << one.name;
    EXPECT_EQ(html.find("!["), std::string::npos) << one.name;
    EXPECT_EQ(html.find("<!--"), std::string::npos) << one.name;
    EXPECT_EQ(html.find("You can"), std::string::npos) << one.name << ": the goal is no explanation";
    for (const char* tag : {"p", "b", "em", "code"}) {
      const auto count = [&html](const std::string& text) {
        std::size_t n = 0;
        for (std::size_t at = html.find(text); at != std::string::npos; at = html.find(text, at + 1)) ++n;
        return n;
      };
      EXPECT_EQ(count(std::string("<") + tag + ">"), count(std::string("</") + tag + ">"))
          << one.name << " " << tag;
    }
  }
  for (std::size_t k = 1; k <= class_count; ++k) {
    const auto label = static_cast<Label>(k);
    const bool has_its_own =
        label != Label::unexplained;  // of another renderer's picture: the budget as a whole
    EXPECT_EQ(report::lesson_of(label).name != "error-budget", has_its_own) << k;
    const std::string html = report::lesson_html(
        report::lesson_of(label));  // words alone: the page sets neither tables nor formulas
    EXPECT_EQ(html.find("<p>|"), std::string::npos) << report::lesson_of(label).name;
    EXPECT_EQ(html.find("<p>    "), std::string::npos) << report::lesson_of(label).name;
  }
}

std::size_t times(std::string_view text, std::string_view word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

std::string_view between_parts(std::string_view text, std::string_view from, std::string_view to) {
  const std::size_t begin = text.find(from), end = text.find(to);
  return begin < end && end != std::string_view::npos ? text.substr(begin, end - begin) : std::string_view();
}

std::string_view last_paragraph(std::string_view text) {
  return text.substr(text.rfind("\n\n"));
}

// Goal, explanation, closed form beside the measurement, three experiments with commands, questions with folded
// answers, and the way to the next lesson.
TEST(Lessons, HaveTheirParts) {
  const auto lessons = report::all_lessons();
  for (std::size_t i = 0; i < lessons.size(); ++i) {
    const auto& [name, title, text, command] = lessons[i];
    EXPECT_NE(title.find(": "), std::string_view::npos) << name;
    EXPECT_TRUE(text.starts_with(std::string("# ").append(title).append("\n\n## Goal\n\n"))) << name;
    for (const char* part :
         {"\n## The closed form beside the measurement\n", "\n## Experiments\n", "\n## Questions\n"})
      EXPECT_EQ(times(text, part), 1u) << name << part;
    const std::string_view experiments = between_parts(text, "\n## Experiments\n", "\n## Questions\n");
    for (const char* number : {"\n**1. ", "\n**2. ", "\n**3. "})
      EXPECT_EQ(times(experiments, number), 1u) << name << number;
    EXPECT_GE(times(experiments, "\ngnomon "), 3u) << name;
    EXPECT_GE(times(text, "<details><summary>"), 3u) << name;
    EXPECT_EQ(times(text, "<details><summary>"), times(text, "</summary>\n\n")) << name;
    EXPECT_EQ(times(text, "<details><summary>"), times(text, "\n\n</details>\n")) << name;
    EXPECT_EQ(times(text, "<!-- live: "), times(text, " -->\n!["))
        << name << ": a figure without its picture";
    const std::string_view next = lessons[(i + 1) % lessons.size()].name;
    EXPECT_EQ(times(last_paragraph(text), std::string("(").append(next).append(".md)")), 1u) << name;
  }
}

TEST(PageShell, DataFilesHoldWhatWasPutIn) {
  const report::DataPart part{"light-0", R"({"a":[1,"]="],"b":";\n"})"};
  EXPECT_EQ(report::data_in_file(data_file(part)), part.json);
  EXPECT_EQ(report::data_in_file("something else"), "");
}

}  // namespace
}  // namespace gnomon::compare
