// The shadow lab by keyboard: every key does what docs/lab.md says of it, in the pictures, in the menus and on the disk.
#include <fmt/format.h>

#include "tests/view/view_lab_fixture.h"

namespace gnomon::app_test {
namespace {

/// What each key of a list leaves on the screen or in the printed command, one after the other.
std::string press_all(const Words& keys, const std::string& then) {
  std::string script;
  for (std::size_t i = 0; i < keys.size(); ++i)
    script += fmt::format("key {}\nwait done\n{}\n", keys[i], fmt::vformat(then, fmt::make_format_args(i)));
  return script;
}

TEST_F(ViewLab, EveryKeyThatSetsSomethingSetsIt) {
  const Words keys{"left", "up",    "pagedown", "ctrl+left", "ctrl+up",    "[",         ";",  "=",
                   "0",    "8",     ",",        "D",         "K",          "F6",        "F7", "F8",
                   "F9",   "right", "down",     "pageup",    "ctrl+right", "ctrl+down", "]",  "'",
                   "-",    "9",     ".",        "R",         "space"};
  const Words commands =
      printed("floating-box",
              "set panels off\nset size 96x64\nset map-size 128\nset slope-bias 1\nset film sun\nprint\n" +
                  press_all(Words(keys.begin(), keys.end() - 1), "print") +
                  "key space\nwait 30\nkey space\nwait done\nprint\n");
  ASSERT_EQ(commands.size(), keys.size() + 1);
  for (std::size_t i = 0; i < keys.size(); ++i) EXPECT_NE(commands[i], commands[i + 1]) << keys[i];
}

// The first key of each pair changes what the window shows, and the second brings it back.
TEST_F(ViewLab, EveryKeyThatShowsSomethingShowsIt) {
  const std::pair<const char*, const char*> pairs[] = {
      {"2", "1"},   {"3", "tab"},     {"4", "1"},           {"5", "1"},     {"6", "1"},      {"G", "1"},
      {"T", "1"},   {"Z", "shift+Z"}, {"ctrl+=", "ctrl+-"}, {"F1", "esc"},  {"H", "F1"},     {"F2", "F2"},
      {"F3", "F3"}, {"F4", "F4"},     {"F5", "F5"},         {"F11", "F11"}, {"ctrl+K", "X"}, {"F10", "esc"}};
  Words keys;
  for (const auto& [there, back] : pairs) keys.insert(keys.end(), {there, back});
  printed("floating-box",
          "set size 800x600\nset results off\nset bias 0texel\nwait done\nscreenshot start.png\n" +
              press_all(keys, "screenshot {}.png") +
              "key V\nwait done\nscreenshot swipe.png\nkey ctrl+,\nscreenshot line.png\n"
              "key V\nwait done\nscreenshot quad.png\n");
  const auto start = texels("start.png");
  for (std::size_t i = 0; i < keys.size(); i += 2) {
    EXPECT_NE(texels(fmt::format("{}.png", i)), start) << keys[i];
    EXPECT_EQ(texels(fmt::format("{}.png", i + 1)), start) << keys[i] << ", " << keys[i + 1];
  }
  EXPECT_NE(texels("swipe.png"), start);
  EXPECT_NE(texels("line.png"), texels("swipe.png"));
  EXPECT_NE(texels("quad.png"), texels("line.png"));
}

// Into the menus, down to "Save as scene", and the key that presses it.
TEST_F(ViewLab, MenusObeyTheKeys) {
  const Words said = printed("floating-box",
                             "set size 800x600\nset map-size 64\nwait done\nkey F10\nkey down\nkey down\n"
                             "key down\nkey space\nwait done\nprint\n");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].find("--camera-orbit"), std::string::npos) << said[0];  // no key went to the picture
  EXPECT_TRUE(wrote("floating-box-scene-001.json"));
}

TEST_F(ViewLab, KeysThatWriteFilesWriteThem) {
  const Words said =
      printed("floating-box",
              "set size 300x200\nset panels off\nset map-size 64\nkey P\nwait done\n"
              "key ctrl+P\nwait done\nkey ctrl+S\nwait done\nkey C\nkey Q\nscreenshot never.png\n");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(said[0].starts_with("gnomon compare")) << said[0];
  for (const char* name : {"raster-001.png", "raster-picture-001.png", "scene-001.json"})
    EXPECT_TRUE(wrote(std::string("floating-box-") + name)) << name;
  EXPECT_FALSE(wrote("never.png"));
}

TEST_F(ViewLab, AReportIsWrittenBesideTheWindow) {
  printed("floating-box", "set size 300x200\nset panels off\nset map-size 64\nkey ctrl+R\nwait done\n");
  ASSERT_TRUE(wrote("floating-box-report-001/"));
  EXPECT_NE(read_file(folder_ / "floating-box-report-001/result.json").find("\"size\": 64"),
            std::string::npos);
}

}  // namespace
}  // namespace gnomon::app_test
