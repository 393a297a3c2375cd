// Scenes in which the cause of every wrong pixel is known from how they are built, against the labels that
// the comparison gives: the confusion matrix of docs/labels.md. GNOMON_CONFUSION_FILE=docs/labels.md in the
// environment writes it there, between its two marks.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "compare/result/outputs.h"
#include "compare/result/verdict.h"
#include "tests/support/compare_support.h"

namespace gnomon::test {
namespace {

using compare::Label;
using raster::Technique;

/// What is done to the picture, what label that calls for, and on which wrong pixels of it nothing else can
/// be to blame: an empty function for all of them.
struct Case {
  std::string name, scene;  ///< as the table tells it
  Label cause;
  Compared run;
  std::function<bool(const raytrace::SurfacePoint&)> judged;
  bool small = false;  ///< errors of one half and less are judged instead of wrong pixels
};

const Vec3 overhead(0.0, -1.0, 0.0);
constexpr double half_floor = 5.0;
constexpr ImageSize picture{480, 270};

/// A floor seen whole, and what stands on it.
Scene floor_scene(std::vector<Mesh> casters, const Vec3& sun) {
  casters.insert(casters.begin(), floor_mesh(half_floor, half_floor));
  Scene scene = sunlit_scene(std::move(casters), sun);
  scene.camera = {{1.0, 14.0, 9.0}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.75};
  return scene;
}

/// Level rectangles at one height, facing up.
Mesh plates(const std::vector<std::array<Vec3, 4>>& corners) {
  Mesh mesh;
  mesh.name = "plates";
  for (const std::array<Vec3, 4>& quad : corners) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), quad.begin(), quad.end());
    const bool up = glm::cross(quad[1] - quad[0], quad[2] - quad[0]).y > 0.0;
    mesh.triangles.push_back(up ? std::array{first, first + 1, first + 2}
                                : std::array{first, first + 2, first + 1});
    mesh.triangles.push_back(up ? std::array{first, first + 2, first + 3}
                                : std::array{first, first + 3, first + 2});
  }
  return mesh;
}

/// Places on the map's own grid, for casters that fall on it as one wants.
class Grid {
 public:
  /// Is the grid of the map that the floor alone gets under a sun overhead.
  explicit Grid(int map_size, double height) : height_(height) {
    const Scene scene = floor_scene({}, overhead);
    const World world = make_world(scene);
    const auto view = fit_light_view(world, scene.lights[0], scene.camera,
                                     double(picture.width) / picture.height, map_size);
    if (view) view_ = *view;
  }
  std::array<Vec3, 4> plate(const Vec2& low, const Vec2& high) const {
    return {at(low), at({high.x, low.y}), at(high), at({low.x, high.y})};
  }
  double texel() const { return texel_world_size(view_, 0, 1.0); }
  /// That the map of the finished scene is the one whose grid was used.
  void expect_same(const Compared& run) const {
    const LightFace &a = view_.face(0), &b = run.result.raster.lights[0].map.view.face(0);
    EXPECT_NEAR(a.half_extent.x, b.half_extent.x, 1e-9);
    EXPECT_NEAR(a.half_extent.y, b.half_extent.y, 1e-9);
  }

 private:
  Vec3 at(const Vec2& uv) const {
    const Vec3 p = texel_ray(view_, 0, uv.x, uv.y).at(0.0);
    return {p.x, height_, p.z};
  }
  LightView view_;
  double height_;
};

compare::CompareOptions plain(int map_size, double bias, Technique technique = Technique::hard) {
  compare::CompareOptions options = test_options(picture, map_size, bias);
  options.raster.map.technique = technique;
  options.raster.map.filter.receiver_plane = false;
  options.raster.map.filter.mipmaps = false;
  options.perceptual = false;
  return options;
}

bool on_floor(const raytrace::SurfacePoint& x) {
  return x.position.y < 1e-6;
}

const Vec3 slanting(0.8, -1.3, 0.45);

Case acne() {
  return {"acne",
          "an empty floor, bias 0",
          Label::acne,
          run_comparison(floor_scene({}, slanting), plain(256, 0.0)),
          {}};
}

Case filtered_acne() {
  return {"acne that pcf averages",
          "the same under 3 x 3 comparisons, --filter-plane off",
          Label::acne,
          run_comparison(floor_scene({}, slanting), plain(256, 0.0, Technique::pcf)),
          {}};
}

// A slope bias of 1 leaves no acne on a plane; what 16 bits round away is left.
Case precision() {
  compare::CompareOptions options = plain(4096, 0.0);
  options.raster.map.depth_format = raster::DepthFormat::d16;
  options.raster.map.bias.slope = 1.0;
  return {"precision",
          "the same, slope bias 1, a map of 16 bits",
          Label::stored_depth,
          run_comparison(floor_scene({}, slanting), options),
          {}};
}

// docs/design.md, section 3: the shadow starts bias * sin(theta) - width behind the wall.
Case thin_wall(const char* name, const char* words, Label cause, const raster::Bias& of_map) {
  constexpr double theta = 0.9, width = 0.05, bias = 0.3;
  Scene scene = sunlit_scene({floor_mesh(4, 4), box_mesh({-width, -0.5, -3}, {0, 1.5, 3})},
                             {std::sin(theta), -std::cos(theta), 0});
  scene.camera = {{2.5, 3.0, 1.0}, {0.4, 0, 0}, {0, 1, 0}, 0.6};
  auto options = plain(1024, 0.0);
  options.raster.map.bias = of_map;
  Compared run = run_comparison(std::move(scene), options);
  const double texel = run.light().texel_world[1] / std::cos(theta);
  const double band = bias * std::sin(theta) - width;
  return {name, words, cause, std::move(run), [=](const raytrace::SurfacePoint& x) {
            return on_floor(x) && std::abs(x.position.z) < 2.5 && x.position.x > texel &&
                   x.position.x < band - texel;
          }};
}

Case peter_panning() {
  return thin_wall("peter-panning", "a thin wall, a bias six times its width", Label::peter_panning,
                   {.constant = 0.3, .unit = raster::BiasUnit::world});
}

Case caster_bias() {
  return thin_wall("casters' bias", "the same with the casters' own constant", Label::caster_bias,
                   {.constant = 0.0,
                    .unit = raster::BiasUnit::world,
                    .caster_constant = 0.3,
                    .caster_unit = raster::BiasUnit::world});
}

// Two parallel sheets closer than a texel's depths: everything under the upper one is dark in truth, and
// the nearer half of each texel lies before the depth stored for it.
Case slope_leak() {
  Mesh lid = floor_mesh(half_floor, half_floor);
  for (Vec3& p : lid.positions) p.y = 0.12;
  Scene scene = floor_scene({std::move(lid)}, {1.0, -0.7, 0.3});
  scene.camera = {{7.0, 0.1, 0.5}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.4};
  return {"light leak, one depth for a texel", "a floor under a lid closer than a texel is deep, bias 0",
          Label::light_leak, run_comparison(std::move(scene), plain(16, 0.0)),
          [](const raytrace::SurfacePoint& x) {
            return on_floor(x) && std::abs(x.position.x) < 2.5 && std::abs(x.position.z) < 2.5;
          }};
}

// Where a slat's edge lies over the roof, the moments' mean and variance let light through.
Case bleeding() {
  compare::CompareOptions options = plain(256, 0.02, Technique::vsm);
  options.raster.map.filter.light_bleeding_reduction = 0.0;
  std::vector<Mesh> roofs{box_mesh({-2.0, 1.0, -2.0}, {2.0, 1.05, 2.0})};
  for (double x = -2.0; x < 2.0; x += 0.5) roofs.push_back(box_mesh({x, 40.0, -4.0}, {x + 0.25, 40.05, 4.0}));
  Scene scene = floor_scene(std::move(roofs), overhead);
  scene.camera = {{0.5, 0.7, 6.0}, {0.0, 0.0, 0.0}, {0, 1, 0}, 0.7};
  Compared run = run_comparison(std::move(scene), options);
  const double reach = 4.0 * run.light().texel_world[1];
  return {"light leak of moments", "slats far above a roof, vsm", Label::light_leak, std::move(run),
          [=](const raytrace::SurfacePoint& x) {
            return on_floor(x) && std::abs(x.position.x) < 2.0 - reach &&
                   std::abs(x.position.z) < 2.0 - reach;
          }};
}

Mesh turned_plate(double angle) {
  std::array<Vec3, 4> corners{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double a = angle + 0.5 * pi * (static_cast<double>(k) + 0.5);
    corners[k] = {4.0 * std::cos(a), 1.0, 4.0 * std::sin(a)};
  }
  return plates({corners});
}

Case aliasing() {
  return {"aliasing", "the edges of a turned plate, a coarse map", Label::aliasing,
          run_comparison(floor_scene({turned_plate(0.35)}, overhead), plain(64, 0.01)), on_floor};
}

// The slanting floor shadows itself where the texel's centre misses the plate, and the bias lights it again.
Case uncovered_aliasing() {
  compare::CompareOptions options = plain(128, 1e-3);
  options.raster.map.bias.slope = 1.0;
  return {"aliasing that acne hid", "the same under a slanting sun, slope bias 1", Label::aliasing,
          run_comparison(floor_scene({turned_plate(0.35)}, {0.5, -1.0, 0.3}), options), on_floor};
}

Case missed_feature() {
  const Grid grid(128, 1.0);
  std::vector<std::array<Vec3, 4>> wires;
  for (int u = 8; u <= 120; u += 4) wires.push_back(grid.plate({u - 0.2, 10.0}, {u + 0.2, 118.0}));
  Case out{"missed feature", "wires of 0.4 texel between the texels' centres", Label::missed_feature,
           run_comparison(floor_scene({plates(wires)}, overhead), plain(128, 0.01)), on_floor};
  grid.expect_same(out.run);
  return out;
}

Case false_feature() {
  const Grid grid(128, 1.0);
  std::vector<std::array<Vec3, 4>> grains;
  for (int v = 8; v < 120; v += 4)
    for (int u = 8; u < 120; u += 4) grains.push_back(grid.plate({u + 0.3, v + 0.3}, {u + 0.7, v + 0.7}));
  Case out{"false feature", "grains of 0.4 texel at texels' centres", Label::false_feature,
           run_comparison(floor_scene({plates(grains)}, overhead), plain(128, 0.01)), on_floor};
  grid.expect_same(out.run);
  return out;
}

// Plates and slits of one texel, exactly on the grid: each comparison is right, and five of them drown it.
Case blur() {
  const Grid grid(128, 1.0);
  std::vector<std::array<Vec3, 4>> rows;
  for (int v = 8; v < 60; v += 8) rows.push_back(grid.plate({10.0, v}, {118.0, v + 1.0}));
  for (int v = 68; v < 116; v += 8) rows.push_back(grid.plate({10.0, v + 1.0}, {118.0, v + 8.0}));
  compare::CompareOptions options = plain(128, 0.01, Technique::pcf);
  options.raster.map.filter.radius_texels = 2.5;
  Case out{"blur", "plates and slits of one texel on the grid, pcf over five", Label::blur,
           run_comparison(floor_scene({plates(rows)}, overhead), options), on_floor};
  grid.expect_same(out.run);
  return out;
}

// Plates ten texels wide, and pixels that cover eight or more: the blur alone would reach two texels.
Case mipmap_blur() {
  const Grid grid(1024, 1.0);
  std::vector<std::array<Vec3, 4>> rows;
  for (int v = 40; v < 980; v += 60) rows.push_back(grid.plate({80.0, v}, {940.0, v + 10.0}));
  compare::CompareOptions options = plain(1024, 0.01, Technique::vsm);
  options.raster.map.filter.mipmaps = true;
  options.raster.map.filter.light_bleeding_reduction = 0.0;
  options.raster.size = options.raytrace.size = {128, 72};
  Case out{"blur of mipmaps", "plates of ten texels, pixels of ten and more, vsm", Label::blur,
           run_comparison(floor_scene({plates(rows)}, overhead), options), on_floor};
  grid.expect_same(out.run);
  return out;
}

// The sun is wider than the plates, and the plates lie on the grid: nothing but its size is in the way.
Case light_size() {
  const Grid grid(128, 3.0);
  std::vector<std::array<Vec3, 4>> rows;
  for (int v = 8; v < 116; v += 24) rows.push_back(grid.plate({10.0, v}, {118.0, v + 4.0}));
  Scene scene = floor_scene({plates(rows)}, overhead);
  scene.lights[0].extent = SunDisc{0.4};
  Case out{"light size", "plates narrower than the sun's image", Label::light_size,
           run_comparison(std::move(scene), plain(128, 0.01)), on_floor};
  grid.expect_same(out.run);
  return out;
}

// A plane overhead shadows all of a plane below; the map reaches as far as the box between them.
Case outside_map() {
  Scene scene = sunlit_scene({box_mesh({-1, 0, -1}, {1, 2, 1})}, {0.4, -1.0, 0.25});
  scene.shapes.push_back({"ground", Plane{{0, 0, 0}, {0, 1, 0}}, 0});
  scene.shapes.push_back({"sky", Plane{{0, 20, 0}, {0, 1, 0}}, 0});
  scene.camera = {{3.0, 9.0, 12.0}, {0, 0, 0}, {0, 1, 0}, 0.8};
  return {"outside the map", "two endless planes, and a map about a box between", Label::outside_map,
          run_comparison(std::move(scene), plain(64, 0.05)), on_floor};
}

/// A comparison under a hard test of the user's own.
Compared with_own_shader(const std::string& returned) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "gnomon-confusion";
  std::filesystem::create_directories(folder / "technique");
  std::ofstream(folder / "technique/hard.glsl")
      << "// light.bias and test.gap in a comment are not read\n"
         "float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {\n"
         "  return "
      << returned << ";\n}\n";
  Compared out =
      run_comparison(floor_scene({turned_plate(0.35)}, slanting), plain(256, 0.0), folder.string());
  std::filesystem::remove_all(folder);
  return out;
}

Case custom_shader() {
  return {"custom shader",
          "stripes from a shader of --shader-dir",
          Label::custom_shader,
          with_own_shader("fract(gl_FragCoord.x / 8.0) < 0.5 ? 0.0 : 1.0"),
          {}};
}

/// Makes of a case one of errors of one half and less.
Case small_errors(Case one, std::string name, std::string scene) {
  one.name = std::move(name), one.scene = std::move(scene), one.small = true;
  return one;
}

// Each of 7 x 7 comparisons is right or wrong by the surface's own slope: the floor is grey.
Case grey_acne() {
  compare::CompareOptions options = plain(256, 0.0, Technique::pcf);
  options.raster.map.filter.radius_texels = 3.0;
  options.raster.map.bias.slope = 1.0;
  return small_errors({"", "", Label::acne, run_comparison(floor_scene({}, slanting), options), {}},
                      "acne in grey", "an empty floor, slope bias 1, pcf of 7 x 7, --filter-plane off");
}

// Plates ten texels wide on the grid: what their soft edges have too much is the filter's.
Case soft_edges() {
  const Grid grid(128, 1.0);
  std::vector<std::array<Vec3, 4>> rows;
  for (int v = 8; v < 110; v += 20) rows.push_back(grid.plate({10.0, v}, {118.0, v + 10.0}));
  compare::CompareOptions options = plain(128, 0.01, Technique::pcf);
  options.raster.map.filter.radius_texels = 2.5;
  Case out{"", "", Label::blur, run_comparison(floor_scene({plates(rows)}, overhead), options), on_floor};
  grid.expect_same(out.run);
  return small_errors(std::move(out), "blur of soft edges",
                      "plates of ten texels on the grid, pcf over five");
}

Case faint_bleeding() {
  return small_errors(bleeding(), "faint light leak of moments", "slats far above a roof, vsm");
}

Case penumbra() {
  return small_errors(light_size(), "light size in penumbrae", "plates narrower than the sun's image");
}

constexpr std::array builders{
    acne,       filtered_acne,  grey_acne,  precision,          peter_panning,  caster_bias,   slope_leak,
    bleeding,   faint_bleeding, aliasing,   uncovered_aliasing, missed_feature, false_feature, blur,
    soft_edges, mipmap_blur,    light_size, penumbra,           outside_map,    custom_shader};

using Row = std::array<std::uint64_t, compare::class_count>;

Row count_labels(const Case& one) {
  Row row{};
  const auto& labels = one.run.light().labels.data;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (compare::has_cause(labels[i]) &&
        compare::is_wrong(compare::rungs_at(one.run.light().rungs, i)) != one.small &&
        (!one.judged || one.judged(one.run.result.raytraced.receiver.data[i])))
      ++row[static_cast<std::size_t>(labels[i]) - 1];
  return row;
}

std::string short_name(Label label) {
  std::string name(compare::label_name(label));
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// What the cases' pixels are called, in columns of the labels that occur.
class Table {
 public:
  void add(const Case& one, const Row& row) { rows_.push_back({one.name, one.scene, one.cause, row}); }
  std::string text() const {
    std::string names = "| known cause | scene |", line = "|---|---|", rows;
    for (std::size_t k = 0; k < compare::class_count; ++k)
      if (occurs(k)) names += fmt::format(" {} |", short_name(static_cast<Label>(k + 1))), line += "--:|";
    for (const Line& one : rows_) rows += text_of(one);
    return fmt::format("{}\n{}\n{}", names, line, rows);
  }

 private:
  struct Line {
    std::string name, scene;
    Label cause;
    Row row;
  };
  bool occurs(std::size_t k) const {
    return std::any_of(rows_.begin(), rows_.end(), [k](const Line& one) { return one.row[k] > 0; });
  }
  std::string text_of(const Line& one) const {
    std::string text = fmt::format("| {} | {} |", one.name, one.scene);
    for (std::size_t k = 0; k < one.row.size(); ++k) {
      if (!occurs(k)) continue;
      const bool own = k + 1 == static_cast<std::size_t>(one.cause);
      text += one.row[k] == 0 ? " |" : fmt::format(" {0}{1}{0} |", own ? "**" : "", one.row[k]);
    }
    return text + "\n";
  }
  std::vector<Line> rows_;
};

// One in a hundred: the goal that the project set itself.
TEST(Confusion, LabelsNameTheKnownCause) {
  Table table;
  std::uint64_t all = 0, confused = 0;
  for (const auto build : builders) {
    const Case one = build();
    ASSERT_FALSE(one.run.result.lights.empty()) << one.name;
    const Row row = count_labels(one);
    std::uint64_t pixels = 0;
    for (const std::uint64_t n : row) pixels += n;
    const std::uint64_t others = pixels - row[static_cast<std::size_t>(one.cause) - 1];
    EXPECT_GE(pixels, 100u) << one.name << ": too few pixels to judge by";
    EXPECT_LE(100 * others, pixels) << one.name;
    all += pixels, confused += others;
    table.add(one, row);
  }
  std::printf("%s  %llu of %llu pixels confused\n", table.text().c_str(),
              static_cast<unsigned long long>(confused), static_cast<unsigned long long>(all));
  if (const char* path = std::getenv("GNOMON_CONFUSION_FILE"))
    write_between_marks(path, "confusion matrix",
                        table.text() + fmt::format("\n{} of {} pixels are confused.\n", confused, all));
}

// A shader that reads no bias has none to be told of; one that does is the program's own ladder to its end.
TEST(CustomShader, HasTheBiasThatItReads) {
  const Compared stripes = with_own_shader("fract(gl_FragCoord.x / 8.0) < 0.5 ? 0.0 : 1.0");
  ASSERT_TRUE(stripes.result.raster.custom_shader.has_value());
  EXPECT_EQ(stripes.result.raster.custom_shader->files, std::vector<std::string>{"technique/hard.glsl"});
  EXPECT_EQ(stripes.light().rungs[5].data, stripes.light().rungs[4].data) << "no bias, no step";
  const auto map = nlohmann::json::parse(compare::result_json(stripes.result))["lights"][0]["map"];
  EXPECT_TRUE(map["bias"]["constant_world"].is_null());
  EXPECT_EQ(map["custom_shader"]["reads_bias"], false);
  const std::string verdict = compare::verdict_on(stripes.result, stripes.light()).whole();
  EXPECT_EQ(verdict.find("bias"), std::string::npos) << verdict;

  const Compared same = with_own_shader("test.gap > light.bias.x ? 0.0 : 1.0");
  EXPECT_TRUE(same.result.raster.custom_shader->reads_bias);
  const Compared own = run_comparison(floor_scene({turned_plate(0.35)}, slanting), plain(256, 0.0));
  EXPECT_EQ(same.light().rungs[6].data, own.light().rungs[6].data) << "the same text draws the same";
  EXPECT_EQ(same.light().rungs[5].data, own.light().rungs[5].data);
  std::uint64_t by_rounding = 0;  // only the last rung, which is of floats, is wrong
  for (std::size_t i = 0; i < own.light().labels.data.size(); ++i) {
    const auto wrong = [&](std::size_t k) {
      return std::abs(own.light().rungs[k].data[i] - own.light().rungs[0].data[i]) > 0.5f;
    };
    by_rounding += compare::is_compared(own.light().labels.data[i]) && wrong(6) && !wrong(5) ? 1 : 0;
  }
  EXPECT_EQ(same.light().classes[std::size_t(Label::custom_shader) - 1], by_rounding);
  EXPECT_GT(same.light().classes[std::size_t(Label::acne) - 1], 1000u);
}

}  // namespace
}  // namespace gnomon::test
