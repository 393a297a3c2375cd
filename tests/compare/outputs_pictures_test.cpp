// Pictures, EXR channels and the output folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "compare/result/picture_set.h"
#include "report/write_outputs.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/synthetic_comparison.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::compare {
namespace {

namespace fs = std::filesystem;

std::uint32_t packed(const glm::u8vec3& c) {
  return std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | c.b;
}

TEST(Palette, EveryLabelHasItsOwnColour) {
  std::set<std::uint32_t> colours{packed(right_in_shadow_colour)};
  std::set<std::string_view> names;
  for (int label = -4; label <= static_cast<int>(class_count); ++label) {
    colours.insert(packed(label_colour(static_cast<Label>(label))));
    names.insert(label_name(static_cast<Label>(label)));
  }
  EXPECT_EQ(colours.size(), 6 + class_count);
  EXPECT_EQ(names.size(), 5 + class_count);
  EXPECT_EQ(names.count("unknown"), 0u);
}

TEST(Pictures, LabelPictureShowsEachErrorInItsLabelsColourAsStrongAsItIs) {
  const auto made = make_synthetic();
  const LightComparison& light = made->comparison.lights[0];
  const Rgb8Image image = label_picture(light);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const Label label = light.labels.data[i];
    const bool dark = light.rungs[0].data[i] < 0.5f;
    const glm::u8vec3 right = dark ? right_in_shadow_colour : label_colour(Label::right);
    // Blurred pixels are off by 3/4, all others wholly.
    const glm::u8vec3 wrong =
        label == Label::blur ? glm::u8vec3(0.25f * Vec3f(right) + 0.75f * Vec3f(label_colour(label)) + 0.5f)
                             : label_colour(label);
    ASSERT_EQ(packed(image.data[i]), packed(label == Label::right ? right : wrong)) << "pixel " << i;
  }
}

TEST(Pictures, DifferencePictureColoursWrongPixelsOnly) {
  const auto made = make_synthetic();
  const LightComparison& light = made->comparison.lights[0];
  const Rgb8Image image = difference_picture(made->comparison, light);
  std::uint64_t coloured = 0, false_shadow = 0, missed_shadow = 0;
  for (const glm::u8vec3& c : image.data) {
    coloured += c.r != c.g || c.g != c.b;
    false_shadow += packed(c) == packed(false_shadow_colour);
    missed_shadow += packed(c) == packed(missed_shadow_colour);
  }
  EXPECT_EQ(coloured, light.error.wrong);
  // Blurred pixels differ by 0.75 and get a mixed colour; all others are wholly wrong.
  EXPECT_EQ(false_shadow + missed_shadow + light.classes[7], light.error.wrong);
  EXPECT_GT(false_shadow, 0u);
  EXPECT_GT(missed_shadow, 0u);
}

TEST(Pictures, DisplacementMapsHaveFixedScales) {
  const auto made = make_synthetic();
  LightComparison& light = made->comparison.lights[0];
  const float none = std::numeric_limits<float>::quiet_NaN();
  light.edge_map = light.detachment_map = Image<float>(light.labels.size, none);
  const std::size_t a = light.labels.index(5, 61), b = a + 1, c = a + 2;
  light.edge_map.data[a] = 4.0f, light.edge_map.data[b] = -9.0f, light.edge_map.data[c] = 0.0f;
  light.detachment_map.data[a] = static_cast<float>(16.0 * light.texel_world[1]);
  light.detachment_map.data[b] = static_cast<float>(4.0 * light.texel_world[1]);
  const Rgb8Image edges = edge_picture(light), detached = detachment_picture(light);
  EXPECT_EQ(packed(edges.data[a]), packed(false_shadow_colour));
  EXPECT_EQ(packed(edges.data[b]), packed(missed_shadow_colour));
  EXPECT_EQ(packed(edges.data[c]), 0xffffffu);
  EXPECT_EQ(packed(edges.data[0]), 0u);  // the sky
  EXPECT_EQ(packed(detached.data[a]), packed(magma(1.0)));
  EXPECT_EQ(packed(detached.data[b]), packed(magma(0.25)));
  EXPECT_EQ(packed(detached.data[c]), 0u);
  const auto pictures = encode_pictures(made->comparison);
  ASSERT_TRUE(pictures) << pictures.error().message();
  EXPECT_EQ(pictures->lights[0].edges.file_name, "edge-displacement.png");
  EXPECT_FALSE(pictures->lights[0].detachment.png.empty());
}

TEST(Pictures, DepthMapIsUpsideUpNearIsBrightAndFacesStandApart) {
  const auto made = make_synthetic(2);
  const raster::ShadowMap& one = made->comparison.raster.lights[0].map;
  const Rgb8Image flat = depth_map_picture(one);
  EXPECT_EQ(flat.size, (ImageSize{64, 64}));
  EXPECT_EQ(packed(flat.at(10, 63)), packed(nothing_stored_colour));  // row 0 of the map is lowest
  EXPECT_EQ(packed(flat.at(30, 63 - 34)), packed(viridis(0.75)));     // the ball, stored 0.25
  EXPECT_EQ(packed(flat.at(0, 0)), packed(viridis(1.0 - double{0.6f + 0.004f * 63.0f})));
  const Rgb8Image cube = depth_map_picture(made->comparison.raster.lights[1].map);
  EXPECT_EQ(cube.size, (ImageSize{3 * 64 + 2, 2 * 64 + 1}));
  EXPECT_EQ(packed(cube.at(64, 0)), packed(nothing_stored_colour));  // the gap between the faces
  // The ball on face -x: stored 0.25 between depths 1 and 11 is depth 11 / (11 - 0.25 * 10), on a logarithmic
  // scale.
  const double share = std::log(11.0 / (11.0 - 2.5)) / std::log(11.0);
  EXPECT_EQ(packed(cube.at(64 + 1 + 30, 63 - 34)), packed(viridis(1.0 - share)));
}

TEST(Pictures, ReducedMapKeepsTheNearestDepth) {
  raster::ShadowMap map;
  map.view.size = 5;
  map.depth.assign(25, 1.0f);
  map.depth[map.texel_index(0, 3, 1)] = 0.2f;
  map.depth[map.texel_index(0, 4, 4)] = 0.4f;
  const raster::ShadowMap small = reduced_map(map, 2);
  ASSERT_EQ(small.view.size, 3);
  EXPECT_EQ(small.depth[small.texel_index(0, 1, 0)], 0.2f);
  EXPECT_EQ(small.depth[small.texel_index(0, 2, 2)], 0.4f);
  EXPECT_EQ(std::count(small.depth.begin(), small.depth.end(), 1.0f), 7);
}

TEST(Aov, HasTheChannelsOfTheContract) {
  const auto made = make_synthetic();
  const test::TemporaryFolder own;
  const fs::path folder = own / "out";
  fs::create_directories(folder);
  const std::string path = (folder / "aov.exr").string();
  LightComparison& light = made->comparison.lights[0];
  const std::size_t grey = 7;  // an error of no more than one half has a cause, and is not wrong
  light.labels.data[grey] = Label::blur;
  for (std::size_t k = 0; k < rung_count; ++k) light.rungs[k].data[grey] = k < 6 ? 1.0f : 0.75f;
  const auto written = write_aov(made->comparison, std::vector{path});
  ASSERT_TRUE(written) << written.error().message();
  const auto image = read_channels(path);
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image->size, synthetic::image_size);
  const std::vector<std::string> names{
      "position.X",  "position.Y", "position.Z", "normal.X", "normal.Y", "normal.Z", "truth.V", "point.V",
      "texel.V",     "flat.V",     "stored.V",   "biased.V", "drawn.V",  "class.V",  "cause.V", "object.V",
      "primitive.V", "texel_uv.U", "texel_uv.V", "gap.V",    "R",        "G",        "B"};
  EXPECT_EQ(image->channels.size(), names.size());
  for (const std::string& name : names) ASSERT_NE(image->find(name), nullptr) << name;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    ASSERT_EQ(image->find("cause.V")->values[i], static_cast<float>(light.labels.data[i]));
    ASSERT_EQ(image->find("class.V")->values[i], i == grey ? 0.0f : static_cast<float>(light.labels.data[i]));
    ASSERT_EQ(image->find("flat.V")->values[i], light.rungs[3].data[i]);
    ASSERT_EQ(image->find("R")->values[i], made->comparison.raytraced.color.data[i].r);
  }
  const std::size_t sky = 0, floor = light.labels.index(5, 61);
  EXPECT_EQ(image->find("object.V")->values[sky], -1.0f);
  EXPECT_EQ(image->find("primitive.V")->values[sky], -1.0f);
  EXPECT_EQ(image->find("gap.V")->values[sky], 0.0f);
  EXPECT_EQ(image->find("normal.Y")->values[sky], 0.0f);
  EXPECT_EQ(image->find("object.V")->values[floor], 0.0f);
  EXPECT_EQ(image->find("normal.Y")->values[floor], 1.0f);
  EXPECT_EQ(image->find("texel_uv.V")->values[floor], 7.5f);
  EXPECT_EQ(image->find("gap.V")->values[light.labels.index(5, 60)], -std::numeric_limits<float>::infinity());
}

TEST(Aov, WritesOneFilePerLight) {
  const auto made = make_synthetic(2);
  const test::TemporaryFolder own;
  const fs::path folder = own / "out";
  fs::create_directories(folder);
  std::vector<std::string> places;
  for (const LightComparison& light : made->comparison.lights)
    places.push_back(aov_path(made->comparison, light, (folder / "a.exr").string()));
  ASSERT_TRUE(write_aov(made->comparison, places));
  EXPECT_TRUE(fs::exists(folder / "a-sun.exr"));
  EXPECT_TRUE(fs::exists(folder / "a-lamp-2.exr"));
  EXPECT_FALSE(fs::exists(folder / "a.exr"));
}

TEST(WriteOutputs, WritesEveryFileAndNothingElse) {
  const auto made = make_synthetic(2);
  const test::TemporaryFolder own;
  const fs::path folder = own / "out";
  const auto paths = report::write_outputs(made->comparison, {.folder = folder.string()});
  ASSERT_TRUE(paths) << paths.error().message();
  std::set<std::string> expected{"report.html", "result.json", "result.csv", "raster.png", "raytrace.png"},
      found;
  for (const char* kind : {"difference", "labels", "error", "depth-map"})
    for (const char* light : {"sun", "lamp-2"}) expected.insert(std::string(kind) + "-" + light + ".png");
  for (const auto& entry : fs::directory_iterator(folder)) found.insert(entry.path().filename().string());
  EXPECT_EQ(found, expected);
  EXPECT_EQ(paths->paths.size(), expected.size());
  EXPECT_FALSE(paths->beside);
  const std::string page = test::bytes_of(folder / "report.html"),
                    json = test::bytes_of(folder / "result.json");
  EXPECT_NE(page.find("ball &amp; &lt;floor&gt;"), std::string::npos);
  EXPECT_EQ(page.find("<floor>"), std::string::npos);
  const auto picture = read_channels((folder / "raster.png").string());
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->size, synthetic::image_size);
}

TEST(WriteOutputs, WithoutAPageAllElseIsAsEver) {
  const auto made = make_synthetic();
  const test::TemporaryFolder own;
  const fs::path with = own / "with", without = own / "without";
  ASSERT_TRUE(report::write_outputs(made->comparison, {.folder = with.string()}));
  const auto written = report::write_outputs(made->comparison, {.folder = without.string(), .page = false});
  ASSERT_TRUE(written) << written.error().message();
  fs::remove(with / "report.html");
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(with)) {
    const std::string name = entry.path().filename().string();
    ASSERT_TRUE(fs::exists(without / name)) << name;
    if (!name.starts_with("result.")) {  // which hold times
      EXPECT_EQ(test::bytes_of(without / name), test::bytes_of(with / name)) << name;
    }
    ++files;
  }
  EXPECT_EQ(written->paths.size(), files);
  EXPECT_FALSE(fs::exists(without / "report.html"));
}

TEST(WriteOutputs, SaysWhereItCouldNotWrite) {
  const auto made = make_synthetic();
  const auto paths = report::write_outputs(made->comparison, {.folder = "/proc/no-such-folder/out"});
  ASSERT_FALSE(paths);
  EXPECT_EQ(paths.error().kind, ErrorKind::cannot_write);
}

}  // namespace
}  // namespace gnomon::compare
