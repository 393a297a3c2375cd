// gnomon lessons: how a lesson's Markdown is taken apart, and what is said of wrong names and folders. The pages
// themselves are looked at in a browser (lessons_browser_test.mjs).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "lab/lessons/figures.h"
#include "lab/lessons/flatland.h"
#include "lab/lessons/lecture.h"
#include "lab/lessons/lesson_text.h"
#include "lab/lessons/site.h"
#include "tests/support/app_process.h"

namespace gnomon::app_test {
namespace {

using lab::lessons::read_lesson;

using lab::lessons::read_lesson;

TEST(LessonText, PartsBeginAtHeadingsAndMarks) {
  const auto text = read_lesson("# T\n\nOne\n\n## A\n\n```sh\n## no heading\n```\n<!-- slide -->\nTwo\n");
  ASSERT_EQ(text.parts.size(), 3u);
  EXPECT_EQ(text.parts[0], "# T\n\nOne\n\n");
  EXPECT_NE(text.parts[1].find("## no heading"), std::string::npos);
  EXPECT_EQ(text.parts[2], "Two\n");
  EXPECT_TRUE(text.marks.empty());
}

TEST(LessonText, MarkTakesThePictureBehindIt) {
  const auto text = read_lesson("<!-- live: bias scene=acne-floor bias=0 -->\n![a](b.png)\n\nText\n");
  ASSERT_EQ(text.marks.size(), 1u);
  EXPECT_EQ(text.marks[0].name, "bias");
  EXPECT_EQ(text.marks[0].setting("scene"), "acne-floor");
  EXPECT_EQ(text.marks[0].setting("bias"), "0");
  EXPECT_EQ(text.marks[0].setting("size"), "");
  const auto html = lab::lessons::html_of(text.parts[0]);
  ASSERT_TRUE(html.has_value());
  EXPECT_NE(html->find("<div class=\"live\" data-figure=\"0\">"), std::string::npos) << *html;
  EXPECT_LT(html->find("<img"), html->find("</div>"));
  EXPECT_LT(html->find("</div>"), html->find("Text"));
}

TEST(LessonText, MarkWithoutPictureHasNone) {
  const auto text = read_lesson("<!-- live: whitted -->\nText\n\n```\n<!-- live: x -->\n```\n");
  ASSERT_EQ(text.marks.size(), 1u) << "in code it is no mark";
  EXPECT_LT(text.parts[0].find("</div>"), text.parts[0].find("Text"));
}

TEST(LessonMarkdown, LinksLeadWithinTheSite) {
  const auto target = [](std::string_view file) { return std::string(file == "a.md" ? "a.html" : ""); };
  const std::string html =
      R"(<a href="a.md">A</a> <a href="../defaults.md">D</a> <a href="https://x.org">X</a>)";
  EXPECT_EQ(lab::lessons::with_links(html, target),
            R"(<a href="a.html">A</a> D (<code>docs/defaults.md</code>) <a href="https://x.org">X</a>)");
}

TEST(LessonMarkdown, PictureThatIsMissingIsAnError) {
  EXPECT_FALSE(lab::lessons::with_pictures(R"(<img src="../images/none.png" alt="">)").has_value());
  const auto shown = lab::lessons::with_pictures(R"(<img src="../images/lesson-acne.png" alt="x">)");
  ASSERT_TRUE(shown.has_value());
  EXPECT_TRUE(shown->starts_with("<img src=\"data:image/png;base64,")) << shown->substr(0, 80);
}

// The wall of thin-wall is 0.05 thick and 0.8 high and stands about x = 0 on the floor.
TEST(LessonFlatland, IsTheSceneCut) {
  const auto wall = lab::lessons::flatland("wall");
  ASSERT_TRUE(wall.has_value());
  double left = 0.0, right = 0.0, top = 0.0;
  for (const auto& segment : (*wall)["segments"]) {
    if (segment[1] == 0.0 && segment[3] == 0.0) continue;  // the floor, and the wall's foot
    for (const int end : {0, 2}) {
      left = std::min(left, segment[end].get<double>()), right = std::max(right, segment[end].get<double>());
      top = std::max(top, segment[end + 1].get<double>());
    }
  }
  EXPECT_NEAR(left, -0.025, 1e-12);
  EXPECT_NEAR(right, 0.025, 1e-12);
  EXPECT_NEAR(top, 0.8, 1e-12);
  EXPECT_NEAR((*wall)["light"]["direction"][0].get<double>(), -std::sqrt(3.0) / 2.0, 1e-12);
  EXPECT_FALSE(lab::lessons::flatland("nowhere").has_value());
  EXPECT_FALSE(lab::lessons::structure_cut("trie", "fence").has_value());
}

constexpr std::string_view lesson_of_parts =
    "# T\n\nOne is here. **Two** is\nlong, 1.5 of it. [Three](x.md) ends?\n\n    a = b\n    c = d\n\n"
    "<!-- live: bias scene=acne-floor map-size=64 bias=0 -->\n![p](../images/lesson-acne.png)\n\n| a | b "
    "|\n|---|---|\n\n"
    "<!-- code: a/b.glsl from \"x\" to \"y\" -->\n```glsl\nx();\n\ny();\n```\n\n"
    "<details><summary>Why?</summary>\n\nSo.\n\nAnd so.\n\n</details>\n";

TEST(Lecture, FindsTheLessonsParts) {
  const auto part = [](std::string_view kind, std::string_view words) {
    return lab::lessons::lesson_part(lesson_of_parts, kind, words).value_or("none");
  };
  EXPECT_EQ(part("sentence", "One is"), "One is here.\n");
  EXPECT_EQ(part("sentence", "Two"), "**Two** is long, 1.5 of it.\n") << "with its mark, to its end";
  EXPECT_EQ(part("sentence", "[Three]"), "Three ends?\n") << "a slide leads nowhere";
  EXPECT_EQ(part("sentence", "is here"), "none") << "no sentence begins so";
  EXPECT_EQ(part("formula", "a ="), "    a = b\n    c = d\n");
  EXPECT_EQ(part("code", "a/b.glsl"), "```glsl\nx();\n\ny();\n```\n");
  EXPECT_EQ(part("code", "x();"), "none") << "code is named by its mark";
  EXPECT_EQ(part("table", "| a"), "| a | b |\n|---|---|\n");
  EXPECT_EQ(part("question", "Why"), "**Why?**\n\n===\n\n\nSo.\n\nAnd so.\n\n");
  EXPECT_EQ(part("figure", "bias size with map-size=16"), "none");
  EXPECT_EQ(
      part("figure", "bias scene=acne-floor with map-size=16 texels=3"),
      "<!-- live: bias scene=acne-floor map-size=16 bias=0 texels=3 -->\n![p](../images/lesson-acne.png)\n");
}

TEST(Lecture, IsALessonsTextOfSteps) {
  const auto text = lab::lessons::lecture_text(
      "# T\n\n<!-- minutes: 1 -->\n\n> Own.\n\n## Q\n\n<!-- minutes: 2 -->\n<!-- show: acne question A finer "
      "map -->\n\nSay it.\n");
  ASSERT_TRUE(text.has_value());
  const auto parts = read_lesson(*text).parts;
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NE(parts[0].find("<div class=\"step sentence\">\n\nOwn.\n"), std::string::npos) << parts[0];
  EXPECT_LT(parts[1].find("<div class=\"step question\">"), parts[1].find("<div class=\"step sentence\">"));
  EXPECT_NE(parts[1].find("<aside class=\"notes\" data-minutes=\"2\">\n\n\nSay it."), std::string::npos)
      << parts[1];
  for (const char* wrong :
       {"# T\n\n## No minutes\n", "# T\n\n<!-- minutes: 1 -->\n<!-- show: acne sentence No such -->\n",
        "# T\n\n<!-- minutes: 1 -->\n<!-- show: acme figure bias -->\n"})
    EXPECT_FALSE(lab::lessons::lecture_text(wrong).has_value()) << wrong;
}

TEST(Lecture, SaysWhatMayBeLeftOut) {
  const auto text = lab::lessons::lecture_text(
      "# T\n\n<!-- minutes: 1 -->\n\n## Q\n\n<!-- minutes: 2 -->\n<!-- beyond -->\n\nSay it.\n");
  ASSERT_TRUE(text.has_value());
  EXPECT_NE(text->find("data-minutes=\"1\">"), std::string::npos);
  EXPECT_NE(text->find("data-minutes=\"2\" data-beyond=\"\">\n\n\nSay it."), std::string::npos) << *text;
}

// Who chooses another scene in the page has a map that is fitted to that.
TEST(LessonFigures, AWindowIsItsScenesOwn) {
  app::Console quiet(true);
  const auto comparison = [&](const std::string& scene) {
    const auto json = lab::lessons::compute_figure(
        lab::lessons::read_mark("two-passes scene=" + scene +
                                " window-of=teapot window-size=0.6,0.6 passes=0"),
        quiet);
    return json ? nlohmann::json::parse(*json)["figures"][0]["data"]["comparison"].get<std::string>()
                : json.error().message();
  };
  EXPECT_EQ(comparison("teapot"), "teapot --window-size 0.6,0.6 --map-size 64/");
  EXPECT_EQ(comparison("acne-floor"), "acne-floor --map-size 64/");
}

TEST(LessonsCommand, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  expect_one_line(run_gnomon({"lessons", "-o", folder / "site", "--only", "acn"}), 2, "acne");
  expect_one_line(run_gnomon({"site", "-o", folder / "site", "--web", folder / "none"}), 3, "./gnomon web");
  EXPECT_FALSE(std::filesystem::exists(folder / "site"));
  expect_one_line(run_gnomon({"lessons", "-o", folder / "site", "--lecture", "shadow"}), 2, "shadows");
  expect_one_line(run_gnomon({"lessons", "--lecture", "shadows", "--only", "acne"}), 2, "--lecture");
  std::ofstream(folder / "file") << "x";
  expect_one_line(run_gnomon({"lessons", "-o", folder / "file", "--only", "precision"}), 4, "file");
}

TEST(LessonsCommand, WritesThePagesThatAreAskedFor) {
  const TemporaryFolder folder;
  const ProcessResult made = run_gnomon({"lessons", "-o", folder / "site", "--only", "precision,hybrid"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out, "");
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "site"))
    files.push_back(entry.path().filename().string());
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files, (std::vector<std::string>{"hybrid.html", "index.html", "precision.html"}));
}

}  // namespace
}  // namespace gnomon::app_test
