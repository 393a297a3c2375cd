// The script language: what is accepted, and where a mistake is said to be.
#include "app/view/script.h"

#include <gtest/gtest.h>

namespace gnomon::app {
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
  EXPECT_EQ(only_change<PickLight>("set light lamp").light, 1u);
  EXPECT_EQ(only_change<LightAzimuthTo>("set light-azimuth -122").azimuth, -122.0);
  EXPECT_EQ(only_change<LightElevationTo>("set light-elevation 46.5").elevation, 46.5);
  EXPECT_EQ(only_change<OrbitTo>("set camera-orbit 30 -20").elevation, -20.0);
  EXPECT_EQ(only_change<DistanceTo>("set camera-distance 7.5").distance, 7.5);
  EXPECT_EQ(only_change<SetMapOption>("set map-size 512").value, "512");
  EXPECT_EQ(only_change<SetMapOption>("set bias -0.5texel").name, "bias");
  EXPECT_EQ(only_change<SetMapOption>("set receiver-plane off").value, "off");
}

TEST(ViewScript, MistakesAreNamedWithTheirLine) {
  EXPECT_EQ(message("wait done\nset bias lots").substr(0, 14), "s.txt:2: bias:");
  EXPECT_EQ(message("set map-size 0").substr(0, 18), "s.txt:1: map-size:");
  EXPECT_NE(message("set map-size 1.5").find("allowed 1 to"), std::string::npos);
  EXPECT_NE(message("set lite-azimuth 3").find("did you mean light-azimuth?"), std::string::npos);
  EXPECT_NE(message("set depth-formt d16").find("did you mean depth-format?"), std::string::npos);
  EXPECT_NE(message("scrrenshot a.png").find("did you mean screenshot?"), std::string::npos);
  EXPECT_NE(message("set light lmap").find("did you mean lamp?"), std::string::npos);
  EXPECT_NE(message("set view side").find("allowed raster, raytrace, difference, labels, depth"),
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

TEST(ViewScript, NothingIsAnEmptyScript) {
  EXPECT_TRUE(parse_script("", "s.txt", lights())->empty());
  EXPECT_TRUE(parse_script("# only words\n\n", "s.txt", lights())->empty());
}

}  // namespace
}  // namespace gnomon::app
