// The script language: what is accepted, and where a mistake is said to be.
#include "lab/view/script/script.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/support/app_process.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::lab {
namespace {

std::vector<Light> lights() {
  Light sun, lamp;
  sun.name = "sun", lamp.name = "lamp";
  return {sun, lamp};
}

template <class Kind>
Kind only_change(const std::string& line) {
  const auto steps = parse_script(line, "s.txt", lights());
  if (!steps) {
    ADD_FAILURE() << steps.error().message();
    return {};
  }
  const Change* change = std::get_if<Change>(&steps->at(0).what);
  const Kind* kind = change == nullptr ? nullptr : std::get_if<Kind>(change);
  EXPECT_NE(kind, nullptr) << line;
  return kind == nullptr ? Kind{} : *kind;
}

std::string message(const std::string& text) {
  const auto steps = parse_script(text, "s.txt", lights());
  if (steps) return "accepted";
  EXPECT_EQ(steps.error().kind, ErrorKind::bad_input);
  return steps.error().message();
}

TEST(ViewScript, StepsKeepTheirLines) {
  const auto steps =
      parse_script("# a tour\n\n  set view labels # by hand\nwait done\nwait 3\r\nscreenshot a/b.PNG\nquit\n",
                   "s.txt", lights());
  ASSERT_TRUE(steps) << steps.error().message();
  ASSERT_EQ(steps->size(), 5u);
  EXPECT_EQ((*steps)[0].line, 3);
  EXPECT_TRUE(std::holds_alternative<WaitDone>((*steps)[1].what));
  EXPECT_EQ(std::get<WaitFrames>((*steps)[2].what).frames, 3);
  EXPECT_EQ(std::get<Screenshot>((*steps)[3].what).path, "a/b.PNG");
  EXPECT_TRUE(std::holds_alternative<Quit>((*steps)[4].what));
  EXPECT_EQ((*steps)[4].line, 7);
}

TEST(ViewScript, EveryKeySets) {
  EXPECT_EQ(only_change<Show>("set view difference").picture, Picture::difference);
  EXPECT_EQ(only_change<Resize>("set size 640x360").size, (ImageSize{640, 360}));
  EXPECT_EQ(only_change<LightAzimuthTo>("set light-azimuth -122").azimuth, -122.0);
  EXPECT_EQ(only_change<LightElevationTo>("set light-elevation 46.5").elevation, 46.5);
  EXPECT_EQ(only_change<OrbitTo>("set camera-orbit 30 -20").elevation, -20.0);
  EXPECT_EQ(only_change<DistanceTo>("set camera-distance 7.5").distance, 7.5);
  EXPECT_EQ(only_change<LightDistanceTo>("set light-distance 3").distance, 3.0);
  EXPECT_EQ(only_change<LightSizeTo>("set light-size 0.5").size, 0.5);
  EXPECT_EQ(only_change<FilmTo>("set film-time 2.5").seconds, 2.5);
  EXPECT_TRUE(only_change<PlayFilm>("set film-play on").on);
  EXPECT_EQ(only_change<TargetTo>("set camera-target 1 -2 3.5").target, Vec3(1.0, -2.0, 3.5));
  EXPECT_EQ(only_change<SunHour>("set time-of-day 9.5").hours, 9.5);
  EXPECT_EQ(only_change<SetPrecision>("set precision exact").precision, raytrace::Precision::exact);
  EXPECT_EQ(only_change<SetLayout>("set layout quad").layout, PaneLayout::quad);
  EXPECT_EQ(only_change<SetPane>("set pane 4 gap").picture, Picture::gap);
  EXPECT_EQ(only_change<SwipeTo>("set swipe 0.25").share, 0.25);
  EXPECT_EQ(only_change<ZoomPictureTo>("set zoom 4").zoom, 4.0);
  EXPECT_EQ(only_change<ProbePixel>("set probe 12 7").pixel, (PixelPlace{12, 7}));
  EXPECT_EQ(only_change<SetTheme>("set theme light").theme, Theme::light);
  EXPECT_EQ(only_change<SetUiScale>("set ui-scale 2").scale, 2.0);
  EXPECT_FALSE(only_change<SetFlag>("set panels off").on);
  EXPECT_EQ(only_change<SetMapOption>("set map-size 512").value, "512");
  EXPECT_EQ(only_change<SetMapOption>("set bias -0.5texel").name, "bias");
  EXPECT_EQ(only_change<SetMapOption>("set receiver-plane off").value, "off");
}

TEST(ViewScript, StepsBesideSet) {
  const auto steps = parse_script(
      "drag 1 2 30 40 right\nclick 5 6\nshow leak\nsave-scene a.json\nprint\nopen fence\n"
      "set light sun\ndrag light 7 8\ndrop acne\nprint clipboard\nset film camera-walk\npoint 9 10\n",
      "s.txt", lights());
  ASSERT_TRUE(steps) << steps.error().message();
  const auto& drag = std::get<DragPointer>((*steps)[0].what);
  EXPECT_EQ(drag.to, Vec2(30.0, 40.0));
  EXPECT_EQ(drag.button, 1);
  EXPECT_EQ(std::get<DragPointer>((*steps)[1].what).from, std::get<DragPointer>((*steps)[1].what).to);
  EXPECT_EQ(std::get<UsePreset>((*steps)[2].what).preset, 3u);
  EXPECT_EQ(std::get<SaveScene>((*steps)[3].what).path, "a.json");
  EXPECT_TRUE(std::holds_alternative<PrintCommand>((*steps)[4].what));
  EXPECT_EQ(std::get<OpenScene>((*steps)[5].what).name, "fence");
  EXPECT_EQ(std::get<PickByName>((*steps)[6].what).name, "sun");
  EXPECT_EQ(std::get<PickByName>((*steps)[6].what).kind, PickByName::Kind::light);
  EXPECT_TRUE(std::get<DragPointer>((*steps)[7].what).light);
  EXPECT_EQ(std::get<DragPointer>((*steps)[7].what).to, Vec2(7.0, 8.0));
  EXPECT_EQ(std::get<DropFile>((*steps)[8].what).path, "acne");
  EXPECT_TRUE(std::holds_alternative<PrintClipboard>((*steps)[9].what));
  EXPECT_EQ(std::get<PickByName>((*steps)[10].what).name, "camera-walk");
  EXPECT_EQ(std::get<PickByName>((*steps)[10].what).kind, PickByName::Kind::film);
  EXPECT_EQ(std::get<PointAt>((*steps)[11].what).at, Vec2(9.0, 10.0));
}

TEST(ViewScript, LightsAreThoseOfTheSceneOpenedLast) {
  EXPECT_NE(message("open fence\nset light lamp").find("s.txt:2: light:"), std::string::npos);
  EXPECT_NE(message("open no-such-scene").find("s.txt:1:"), std::string::npos);
}

TEST(ViewScript, MistakesAreNamedWithTheirLine) {
  EXPECT_EQ(message("wait done\nset bias lots").substr(0, 14), "s.txt:2: bias:");
  EXPECT_EQ(message("set map-size 0").substr(0, 18), "s.txt:1: map-size:");
  EXPECT_NE(message("set map-size 1.5").find("allowed 1 to"), std::string::npos);
  EXPECT_NE(message("set lite-azimuth 3").find("did you mean light-azimuth?"), std::string::npos);
  EXPECT_NE(message("set depth-formt d16").find("did you mean depth-format?"), std::string::npos);
  EXPECT_NE(message("scrrenshot a.png").find("did you mean screenshot?"), std::string::npos);
  EXPECT_NE(message("set light lmap").find("did you mean lamp?"), std::string::npos);
  EXPECT_NE(message("set view side")
                .find("allowed raster, raytrace, difference, labels, truth, gap, texels, depth"),
            std::string::npos);
}

TEST(ViewScript, IncompleteOrExcessiveLinesAreErrors) {
  for (const char* line : {"set",
                           "set bias",
                           "set bias 1 2",
                           "set camera-orbit 30",
                           "set camera-orbit 30 20 10",
                           "wait",
                           "wait 0",
                           "wait -3",
                           "wait soon",
                           "wait done now",
                           "screenshot",
                           "screenshot a.jpg",
                           "screenshot .png.exr",
                           "quit now",
                           "drag 1 2 3",
                           "drag 1 2 3 4 upper",
                           "click 1",
                           "point 1",
                           "point here 1",
                           "show",
                           "show shadows",
                           "open",
                           "print all",
                           "key",
                           "key N",
                           "key ctrl+1",
                           "key hyper+Z",
                           "save-scene a.glb",
                           "set pane 5 gap",
                           "set swipe 2",
                           "set zoom 0.5",
                           "set panels perhaps",
                           "set ui-scale 4",
                           "set time-of-day 25",
                           "set camera-target 1 2",
                           "set size 0x5",
                           "set size 640",
                           "set camera-distance 0",
                           "set camera-distance nan",
                           "set camera-orbit 0 90",
                           "set light-elevation 91",
                           "set view",
                           "set light-azimuth 1e999",
                           "set receiver-plane perhaps"}) {
    EXPECT_NE(message(line), "accepted") << line;
  }
}

std::string text_of(const std::string& name) {
  return test::bytes_of(test::source_dir() + "/" + name);
}

/// The first word of everything between backticks.
std::set<std::string> quoted_words(const std::string& text) {
  const std::regex quoted("`([^` ]+)[^`]*`");
  std::set<std::string> words;
  for (std::sregex_iterator it(text.begin(), text.end(), quoted), end; it != end; ++it)
    words.insert((*it)[1]);
  return words;
}

/// The language, docs/lab.md and the manual, which is the program's own help, have the same words.
TEST(ViewScript, EveryWordIsInTheManual) {
  const std::string page = text_of("docs/lab.md"), manual = app_test::run_gnomon({"--manual", "options"}).out;
  const std::size_t scripts = page.find("## Scripts"), keys = page.find("\nKeys: ", scripts);
  ASSERT_NE(keys, std::string::npos);
  const std::set<std::string> steps = quoted_words(page.substr(scripts, keys - scripts)),
                              names = quoted_words(page.substr(keys));
  const std::size_t option = manual.find("- `--script FILE`");
  ASSERT_NE(option, std::string::npos);
  const std::string help = manual.substr(option, manual.find("\n- ", option) - option);
  for (const std::string_view verb : script_verbs()) {
    EXPECT_TRUE(steps.contains(std::string(verb))) << verb;
    EXPECT_TRUE(std::regex_search(help, std::regex(fmt::format("\\b{}\\b", verb)))) << verb;
  }
  for (const std::string& name : script_key_names()) EXPECT_TRUE(names.contains(name)) << name;
}

TEST(ViewScript, NothingIsAnEmptyScript) {
  EXPECT_TRUE(parse_script("", "s.txt", lights())->empty());
  EXPECT_TRUE(parse_script("# only words\n\n", "s.txt", lights())->empty());
}

}  // namespace
}  // namespace gnomon::lab
