// The comparison's long lists, against slower ways to the same: sorted numbers, numbers on the disk, pixels that something
// holds of, pixels by their texel, and the closed form of a plane's depth slope.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <random>

#include "compare/ladder/biased_test.h"
#include "compare/measure/number_list.h"
#include "compare/metrics/pixel_list.h"
#include "compare/truth/texel_groups.h"
#include "scene/base/parallel.h"
#include "tests/support/every_target.h"

namespace gnomon::compare {
namespace {

using raytrace::TexelKey;

constexpr float inf = std::numeric_limits<float>::infinity();

std::vector<float> random_gaps(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<float> share(-1.0f, 1.0f);
  std::vector<float> values(count);
  for (float& v : values) {
    const float s = share(random);
    v = s < -0.9f ? -inf : s > 0.95f ? inf : std::abs(s) < 0.1f ? 0.25f : s * s * s;
  }
  return values;
}

void expect_standard_order() {
  std::mt19937 random(1);
  for (const std::size_t count : {0, 1, 2, 7, 16, 100, 1000, 4097, 100'000}) {
    std::vector<float> floats = random_gaps(count, random);
    std::vector<float> expected = floats;
    std::sort(expected.begin(), expected.end());
    sort_numbers(std::span(floats));
    EXPECT_EQ(floats, expected) << count;

    std::vector<std::uint64_t> numbers(count);
    for (auto& n : numbers) {
      n = std::uint64_t{random()} << (random() % 33);
      n |= random() & 1;
    }
    std::vector<std::uint64_t> ascending = numbers;
    std::sort(ascending.begin(), ascending.end());
    sort_numbers(std::span(numbers));
    EXPECT_EQ(numbers, ascending) << count;
  }
}

TEST(SortNumbers, EqualsTheStandardSortOnEveryInstructionSet) {
  test::for_each_target(expect_standard_order);
}

TEST(SortNumbers, PutsWhatIsNoNumberLast) {
  std::mt19937 random(2);
  std::vector<float> values = random_gaps(10'000, random);
  for (std::size_t i = 0; i < values.size(); i += 7)
    values[i] = std::copysign(std::numeric_limits<float>::quiet_NaN(), i % 2 == 0 ? 1.0f : -1.0f);
  const auto is_number = [](float v) { return !std::isnan(v); };
  const auto numbers = std::count_if(values.begin(), values.end(), is_number);
  sort_numbers(std::span(values));
  EXPECT_TRUE(std::is_sorted(values.begin(), values.begin() + numbers));
  EXPECT_TRUE(std::all_of(values.begin(), values.begin() + numbers, is_number));
  EXPECT_TRUE(std::none_of(values.begin() + numbers, values.end(), is_number));
}

TEST(PixelList, HoldsThemInOrder) {
  for (const std::size_t count : {0, 1, 16'384, 16'385, 100'000}) {
    const auto holds = [](std::size_t i) { return i % 3 == 0 || i % 1000 < 10; };
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < count; ++i)
      if (holds(i)) expected.push_back(static_cast<std::uint32_t>(i));
    EXPECT_EQ(pixels_where(count, holds), expected) << count;
  }
}

/// Lookups all over a cube map and a little beyond.
raster::LightRecord random_lookups(ImageSize size, int map_size, std::mt19937& random) {
  raster::LightRecord record;
  record.map.view.size = map_size, record.map.view.face_count = 6;
  record.texel_uv = Image<Vec2f>(size), record.face = Image<std::uint8_t>(size);
  std::uniform_real_distribution<float> place(-1.0f, static_cast<float>(map_size) + 1.0f);
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    record.texel_uv.data[i] = Vec2f{place(random), place(random)};
    record.face.data[i] = static_cast<std::uint8_t>(random() % 6);
  }
  return record;
}

TEST(TexelGroups, EqualAMapOfLists) {
  std::mt19937 random(3);
  for (const int map_size : {1, 16, 65536}) {
    const raster::LightRecord record = random_lookups({300, 100}, map_size, random);
    std::vector<std::uint32_t> pixels, outside, expected_outside;
    std::map<TexelKey, std::vector<std::uint32_t>> expected;
    for (std::uint32_t i = 0; i < 30'000; ++i) {
      if (i % 5 == 0) continue;
      pixels.push_back(i);
      TexelKey key;
      (texel_of_pixel(record, i, key) ? expected[key] : expected_outside).push_back(i);
    }
    const TexelGroups groups = group_by_texel(record, pixels, outside);
    EXPECT_EQ(outside, expected_outside);
    ASSERT_EQ(groups.keys.size(), expected.size());
    std::size_t g = 0;
    for (const auto& [key, members] : expected) {
      EXPECT_EQ(groups.keys[g], key);
      EXPECT_TRUE(std::equal(members.begin(), members.end(), groups[g].begin(), groups[g].end()));
      ++g;
    }
  }
}

/// A map that looks down a slant, with texels twice as long as wide.
LightView slanted_map(double warp) {
  LightView view;
  view.size = 64;
  LightFace& face = view.faces[0];
  face.forward = glm::normalize(Vec3(1.0, -2.0, 0.5));
  face.right = glm::normalize(glm::cross(face.forward, Vec3(0.0, 0.0, 1.0)));
  face.up = glm::cross(face.right, face.forward);
  face.half_extent = Vec2(3.0, 6.0);
  face.center = Vec2(0.5, -0.25);
  face.warp = warp;
  return view;
}

// The closed form of even texels, against the depths of the plane half a texel to both sides: those of a warp
// that is as good as none.
TEST(TexelDepthSlope, OfEvenTexelsIsThePlanesOwn) {
  const LightView even = slanted_map(0.0), general = slanted_map(1e-14);
  const Vec3 position(0.7, 0.3, -0.4);
  const TexelCoordinate at = project_to_face(even, 0, position);
  for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(-1, 0.2, 0.1), Vec3(-0.3, 1, -2), Vec3(0.1, 0.5, 3)}) {
    const Vec3 normal = glm::normalize(direction);
    const double slope = texel_depth_slope(even, at, position, normal);
    const double expected = texel_depth_slope(general, at, position, normal);
    if (std::isinf(expected))
      EXPECT_EQ(slope, expected);
    else
      EXPECT_NEAR(slope, expected, 1e-12 * expected);  // of the general form's differences
  }
  EXPECT_TRUE(std::isinf(texel_depth_slope(even, at, position, even.face(0).forward))) << "turned away";
}

// Bands of random lengths, none among them, on either side of the limit: what comes back is what went in, in its order,
// and the list can be filled again.
TEST(NumberList, GivesBackWhatSpilled) {
  std::mt19937 random(4);
  for (const std::size_t limit :
       {std::size_t{0}, std::size_t{400}, std::size_t{4000}, std::size_t{1} << 20}) {
    const Spill spill{testing::TempDir(), limit};
    NumberList<float> list;
    for (int again = 0; again < 2; ++again) {
      std::vector<float> all;
      for (int band = 0; band < 20; ++band) {
        std::vector<float> numbers = random_gaps(random() % 4 * 40, random);
        all.insert(all.end(), numbers.begin(), numbers.end());
        ASSERT_TRUE(list.append(spill, std::move(numbers)));
        EXPECT_EQ(list.count(), all.size());
      }
      const auto back = list.take();
      ASSERT_TRUE(back);
      EXPECT_EQ(*back, all) << "limit " << limit;
      EXPECT_EQ(list.count(), 0U);
    }
  }
}

}  // namespace
}  // namespace gnomon::compare
