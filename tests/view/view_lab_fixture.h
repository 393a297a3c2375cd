// The shadow lab driven by scripts under Xvfb: what it prints and what its screenshots show. Tests of it are skipped where
// there is no Xvfb.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "scene/files/pictures/image_io.h"
#include "tests/support/app_process.h"
#include "tests/view/view_display.h"

namespace gnomon::app_test {

/// A part of the window.
struct Box {
  int x, y, width, height;
};

struct PixelPlace {
  int x = 0, y = 0;
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// "gnomon compare ..." without its first word. No word of it is quoted here.
inline Words words_of(const std::string& command) {
  std::istringstream stream(command);
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words.empty() ? words : Words(words.begin() + 1, words.end());
}

/// One display for all tests, a folder for each.
class ViewLab : public testing::Test {
 protected:
  static void SetUpTestSuite() { display_ = new VirtualDisplay; }
  static void TearDownTestSuite() {
    delete display_;
    display_ = nullptr;
  }
  void SetUp() override {
    if (!display_->missing().empty()) GTEST_SKIP() << display_->missing();
  }
  ProcessResult run(const Words& words) const {
    ProcessOptions options;
    options.folder = folder_.path();
    options.environment = {display_->variable(), "WAYLAND_DISPLAY="};
    return run_gnomon(words, options);
  }
  ProcessResult drive(const std::string& scene, const std::string& script, const Words& more = {}) const {
    write_text(folder_ / "script.txt", script);
    return run(Words{"view", scene, "--script", "script.txt"} + more);
  }
  /// What a script prints that must end well, line by line.
  Words printed(const std::string& scene, const std::string& script, const Words& more = {}) const {
    const ProcessResult result = drive(scene, script, more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("OpenGL"), std::string::npos) << result.err;
    return lines_of(result.out);
  }
  /// The screenshot shows the labels that the printed command writes.
  void expect_labels(const std::string& screenshot, const std::string& command) const {
    const Words more{"-o", "compared", "--runs", "1", "--no-report", "--quiet"};
    EXPECT_EQ(run(words_of(command) + more).exit_code, 0) << command;
    EXPECT_EQ(texels(screenshot), texels("compared/labels.png")) << command;
  }
  /// Pixels that differ between two screenshots of one size, in a part of them.
  std::size_t differing(const std::string& a, const std::string& b, const Box& part) const {
    const auto first = read_texture(folder_ / a, true), second = read_texture(folder_ / b, true);
    EXPECT_TRUE(first && second && first->size == second->size) << a << ", " << b;
    std::size_t count = 0;
    for (int y = part.y; y < part.y + part.height; ++y)
      for (int x = part.x; x < part.x + part.width; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(first->size.width) +
                              static_cast<std::size_t>(x);
        count += first->texels[i] != second->texels[i];
      }
    return count;
  }
  bool wrote(const std::string& name) const {
    const Words entries = folder_.entries();
    return std::find(entries.begin(), entries.end(), name) != entries.end();
  }
  std::vector<glm::u8vec4> texels(const std::string& name) const {
    const auto texture = read_texture(folder_ / name, true);
    EXPECT_TRUE(texture) << name;
    return texture ? texture->texels : std::vector<glm::u8vec4>{};
  }
  /// Reads a texel of a window that is 900 pixels wide; (0, 0, 0, 0): there is none.
  glm::u8vec4 texel(const std::string& name, PixelPlace at) const {
    const auto all = texels(name);
    const std::size_t i = static_cast<std::size_t>(at.y) * 900 + static_cast<std::size_t>(at.x);
    return i < all.size() ? all[i] : glm::u8vec4(0);
  }
  TemporaryFolder folder_;
  static inline VirtualDisplay* display_ = nullptr;
};

}  // namespace gnomon::app_test
