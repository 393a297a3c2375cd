// labels.png is a record: every colour that a wrong pixel can have says its label, and no other pixel has one.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "compare/ladder/labels.h"
#include "compare/result/outputs.h"
#include "scene/files/pictures/image_io.h"
#include "studies/diff/wrong_pixels.h"
#include "tests/support/temporary_folder.h"

namespace gnomon {
namespace {

using compare::Label;

std::array<int, 3> key_of(const glm::u8vec3& c) {
  return {c.r, c.g, c.b};
}

TEST(WrongPixels, NoColourHasTwoLabels) {
  std::map<std::array<int, 3>, std::set<Label>> labels;
  for (int value = int(Label::uncertain); value <= int(Label::right); ++value)
    for (const bool dark : {false, true})
      labels[key_of(compare::label_pixel(Label(value), dark, 0.0f))].insert(Label(value));
  for (std::size_t k = 1; k <= compare::class_count; ++k)
    for (const bool dark : {false, true})
      for (int i = 1; i <= 5000; ++i)
        labels[key_of(compare::label_pixel(Label(k), dark, 0.5f + float(i) / 10000.0f))].insert(Label(k));
  for (const auto& [colour, all] : labels)
    EXPECT_EQ(all.size(), 1u) << colour[0] << " " << colour[1] << " " << colour[2] << ": "
                              << compare::label_name(*all.begin()) << " and "
                              << compare::label_name(*all.rbegin());
}

TEST(WrongPixels, AreReadAsTheyWereDrawn) {
  compare::LightComparison light;
  const ImageSize size{2000, int(compare::class_count)};
  for (Image<float>& rung : light.rungs) rung = Image<float>(size);
  light.labels = Image<Label>(size);
  for (int k = 0; k < size.height; ++k)
    for (int x = 0; x < size.width; ++x) {
      light.labels.at(x, k) = Label(k + 1);
      const float truth = x % 2 == 0 ? 0.0f : 1.0f, error = float(x + 1) / float(size.width);
      light.rungs.front().at(x, k) = truth;
      light.rungs.back().at(x, k) = std::abs(truth - error);
    }
  const test::TemporaryFolder folder;
  const studies::PixelFiles files{folder.path() + "/labels.png", folder.path() + "/error.png"};
  ASSERT_TRUE(write_png(files.labels, compare::label_picture(light)));
  ASSERT_TRUE(write_png(files.error, compare::error_picture(light)));
  const auto read = studies::read_wrong_pixels(files);
  ASSERT_TRUE(read) << read.error().message();
  for (int k = 0; k < size.height; ++k)
    for (int x = 0; x < size.width; ++x) {
      const float error = std::abs(light.rungs.front().at(x, k) - light.rungs.back().at(x, k));
      if (std::abs(error - 0.5f) < 0.002f) continue;
      ASSERT_EQ(read->at(x, k), error > 0.5f ? Label(k + 1) : Label::right)
          << compare::label_name(Label(k + 1)) << " by " << error;
    }
}

}  // namespace
}  // namespace gnomon
