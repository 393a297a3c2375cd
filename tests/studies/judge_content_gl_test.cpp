// Maps of another renderer whose casters are not the scene's, each made from the scene in one way: what its pixels are
// called is that way, never precision, and no bias is advised where none helps.
#include <fmt/ranges.h>

#include "compare/truth/columns.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {
namespace {

using compare::Label;
using judge::Capture;
using judge::StoredDepth;

/// A floor, a box that floats above it and one that stands on it, all with names.
Scene boxes() {
  Mesh high = box_mesh({-1.6, 1.2, -0.8}, {-0.2, 1.6, 0.8}),
       low = box_mesh({0.6, 0.0, -0.6}, {1.6, 0.8, 0.6});
  high.name = "high", low.name = "low";
  Scene scene = sunlit_scene({floor_mesh(4, 4), high, low}, {0.5, -1.0, 0.3});
  scene.camera = {{2.5, 5.0, 6.0}, {0.4, 0.2, 0.2}, {0, 1, 0}, 0.8};
  return scene;
}

/// The picture of `boxes`, with a map that holds what a test puts into it: exact rays through the texels' centres.
struct Captured {
  explicit Captured(const std::string& name, Scene scene = boxes())
      : drawn(draw_scene(std::move(scene), small_picture, hard_map(256))),
        capture(self_capture(drawn, folder_for("content-" + name),
                             {.map = true, .stored = StoredDepth::zero_to_one})) {
    capture.bias = judge::CapturedBias{.constant_depth = 0.002};
  }
  const LightView& view() const { return drawn.result.raster.lights[0].map.view; }
  double range() const { return view().face(0).far_depth - view().face(0).near_depth; }

  /// `keeps(hit)` of a surface of `scene`: it is drawn into the map. `moved`: added to every depth, world units.
  template <class Keeps>
  void hold(const Scene& scene, const Keeps& keeps, double moved = 0.0) {
    const World world = make_world(scene);
    const raytrace::Tracer tracer(world, raytrace::Accel::bvh);
    const LightFace& face = view().face(0);
    spoil(capture.map[0].depth, [&](ChannelImage& image) {
      const int n = view().size;
      for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
          const Ray ray = compare::caster_ray(world, view(), 0, column + 0.5, row + 0.5);
          const auto hit = compare::first_on_ray(
              tracer, ray, infinity, [&](const raytrace::Hit& h) { return keeps(world, ray, h); });
          const double depth =
              hit ? glm::dot(ray.at(hit->t) - view().origin, face.forward) + moved : infinity;
          image.channels[0].values[std::size_t(row * n + column)] =
              depth < face.far_depth ? static_cast<float>(stored_from_depth(view(), 0, row + 0.5, depth))
                                     : 1.0f;
        }
    });
    draw_again(capture, drawn);
  }
  void hold(const Scene& scene, double moved = 0.0) {
    hold(
        scene, [](const World&, const Ray&, const raytrace::Hit&) { return true; }, moved);
  }
  JudgeOutcome judged() const { return judge(capture, *drawn.scene); }

  Compared drawn;
  Capture capture;
};

std::uint64_t pixels_called(const JudgeOutcome& judged, Label label) {
  return judged.result->lights[0].classes[static_cast<std::size_t>(label) - 1];
}

/// Most wrong pixels have the label, hardly any is precision (edges within 1/8 texel), edges may be aliasing; a note says
/// so with these words.
void expect_label(const JudgeOutcome& judged, Label label, const std::string& words) {
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::LightComparison& light = judged.result->lights[0];
  EXPECT_GT(light.error.wrong, 100U);
  std::uint64_t aliasing = 0;
  for (const Label one : {Label::aliasing, Label::missed_feature, Label::false_feature})
    aliasing += pixels_called(judged, one);
  EXPECT_GE(pixels_called(judged, label) + aliasing, light.error.wrong - light.error.wrong / 50);
  EXPECT_GT(4 * pixels_called(judged, label), 3 * light.error.wrong);
  EXPECT_LE(100 * pixels_called(judged, Label::stored_depth), 2 * light.error.wrong);
  // A bias of casters is the bias step's, whatever it shows as; what else a map holds is the casters'.
  const bool bias = label == Label::caster_bias;
  const compare::BudgetStep& step =
      light.budget[bias ? static_cast<std::size_t>(compare::Cause::bias) : compare::cause_count];
  EXPECT_GE(step.false_shadow + step.missed_shadow, pixels_called(judged, label));
  EXPECT_TRUE(bias || step.false_shadow + step.missed_shadow == pixels_called(judged, label));
  EXPECT_GT(step.absolute_mean, 0.0);
  const std::string notes = fmt::format("{}", fmt::join(judged.result->judged->notes, "\n"));
  EXPECT_NE(notes.find(words), std::string::npos) << notes;
}

TEST(JudgeContent, OfTheSceneIsDoubtedNowhere) {
  Captured captured("same");
  captured.hold(boxes());
  const JudgeOutcome judged = captured.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  for (std::size_t k = static_cast<std::size_t>(Label::caster_bias); k <= compare::class_count; ++k)
    EXPECT_EQ(pixels_called(judged, static_cast<Label>(k)), 0U) << label_name(static_cast<Label>(k));
}

/// All but the box that floats.
bool is_not_high(const World& world, const Ray&, const raytrace::Hit& hit) {
  return world.part_of(hit.primitive).mesh->name != "high";
}

// Averages of depths are no surface's own, and yet nothing is missing: what they make is the filter's.
TEST(JudgeContent, OfMomentsLacksWhatIsMissingAndNothingElse) {
  for (const judge::FilterName kind : {judge::FilterName::vsm, judge::FilterName::msm})
    for (const bool missing : {false, true}) {
      Captured captured("moments");
      missing ? captured.hold(boxes(), is_not_high) : captured.hold(boxes());
      captured.capture.filter = judge::CapturedFilter{.kind = kind, .moment_bias = 3e-5};
      store_moments(captured.capture);
      draw_again(captured.capture, captured.drawn);
      const JudgeOutcome judged = captured.judged();
      ASSERT_TRUE(judged.result) << reason(judged);
      if (missing) {
        expect_label(judged, Label::missing_caster, "a caster that is missing from the map");
        continue;
      }
      const auto& budget = judged.result->lights[0].budget;
      EXPECT_EQ(budget[static_cast<std::size_t>(compare::Cause::bias)].false_shadow, 0U);
      EXPECT_EQ(budget[static_cast<std::size_t>(compare::Cause::precision)].absolute_mean, 0.0);
      EXPECT_GT(budget[static_cast<std::size_t>(compare::Cause::filter)].absolute_mean, 0.0);
      for (std::size_t k = static_cast<std::size_t>(Label::caster_bias); k <= compare::class_count; ++k)
        EXPECT_EQ(pixels_called(judged, static_cast<Label>(k)), 0U) << label_name(static_cast<Label>(k));
    }
}

TEST(JudgeContent, WithoutACasterLacksIt) {
  Captured captured("missing");
  captured.hold(boxes(), is_not_high);
  const JudgeOutcome judged = captured.judged();
  expect_label(judged, Label::missing_caster, "mostly of 'high' the map does not hold");
  EXPECT_TRUE(judged.result->judged->advice.empty()) << "no bias brings a caster back";
}

TEST(JudgeContent, OfCastersThatMovedSinceIsStale) {
  Captured captured("moved");
  Scene before = boxes();
  for (Vec3& p : before.meshes[1].positions) p += Vec3(0.5, 0.0, 2.4);
  captured.hold(before);
  const JudgeOutcome judged = captured.judged();
  expect_label(judged, Label::moved_caster, "stands elsewhere in the map");
  EXPECT_TRUE(judged.result->judged->advice.empty());
}

TEST(JudgeContent, OfPushedCastersHasTheirBias) {
  Captured captured("pushed");
  captured.capture.bias->constant_depth = 0.0;
  captured.hold(boxes(), 1.2);
  const JudgeOutcome judged = captured.judged();
  expect_label(judged, Label::caster_bias, "the map was drawn with an offset of 1.2 world units");
  // The advice is in the casters' own terms: hardly any of the push is left.
  const std::vector<compare::Advice>& advice = judged.result->judged->advice;
  ASSERT_FALSE(advice.empty());
  EXPECT_EQ(advice[0].setting, "map[].caster_bias.constant");
  EXPECT_NEAR(advice[0].now * captured.range(), 1.2, 1e-3);
  EXPECT_NEAR(advice[0].instead * captured.range(), 0.05, 0.15);
  EXPECT_LT(advice[0].wrong_instead, 0.2 * advice[0].wrong_now);
}

/// A map whose near plane lies behind all of a box, which alone casts.
Captured clipped() {
  Mesh high = box_mesh({-1.6, 1.2, -0.8}, {-0.2, 1.6, 0.8});
  high.name = "high";
  Scene scene = sunlit_scene({floor_mesh(2.5, 2.0), high}, {0.25, -1.0, 0.15});
  scene.camera = {{2.5, 4.0, 5.0}, {0.0, 0.0, 0.2}, {0, 1, 0}, 0.8};
  Captured captured("clipped", scene);
  const LightFace& face = captured.view().face(0);
  const auto depth = [&](const Vec3& p) { return glm::dot(p - captured.view().origin, face.forward); };
  const double near = depth({-2.5, 0.0, -2.0}) - 0.01;  // the floor's nearest corner
  EXPECT_LT(depth({-0.2, 1.2, 0.8}), near) << "all of the box lies before";
  captured.hold(scene, [&](const World&, const Ray& ray, const raytrace::Hit& hit) {
    return depth(ray.at(hit.t)) >= near;
  });
  const double first = (near - face.near_depth) / captured.range();
  Mat4& matrix = *captured.capture.map[0].clip_from_world;
  for (int column = 0; column < 4; ++column)
    matrix[column][2] = (matrix[column][2] - first * matrix[column][3]) / (1.0 - first);
  spoil(captured.capture.map[0].depth, [&](ChannelImage& image) {
    for (float& v : image.channels[0].values)
      if (v < 1.0f) v = static_cast<float>((double{v} - first) / (1.0 - first));
  });
  draw_again(captured.capture, captured.drawn);
  return captured;
}

TEST(JudgeContent, BehindItsNearPlaneLacksWhatLiesBefore) {
  const JudgeOutcome judged = clipped().judged();
  expect_label(judged, Label::clipped_caster, "before the map's near plane");
  EXPECT_TRUE(judged.result->judged->advice.empty());
}

// A sky that nobody said casts none is in no map, and dark everywhere by rays.
TEST(JudgeContent, OfFoundCastersThatTheMapLacksIsRefusedByName) {
  Captured captured = clipped();
  captured.capture.casters_found = true;
  const JudgeOutcome refused = captured.judged();
  ASSERT_FALSE(refused.result.has_value());
  EXPECT_NE(reason(refused).find("% of the shadow that rays find, and the map holds nothing of it"),
            std::string::npos)
      << reason(refused);
  // Of casters that the map holds everything is judged.
  Captured held("found");
  held.hold(boxes());
  held.capture.casters_found = true;
  EXPECT_TRUE(held.judged().result.has_value()) << reason(held.judged());
}

/// A board in the air whose front looks at the sun, and nothing behind it.
Scene board(AlphaMode alpha = AlphaMode::opaque) {
  Scene scene = boxes();
  Mesh flat;
  flat.name = "board";
  flat.positions = {{-3.0, 1.5, -1.5}, {-3.0, 1.5, 1.5}, {0.0, 1.5, 1.5}, {0.0, 1.5, -1.5}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene =
      sunlit_scene({floor_mesh(4, 4), flat, box_mesh({0.6, 0.0, -0.6}, {1.6, 0.8, 0.6})}, {0.5, -1.0, 0.3});
  scene.camera = {{2.5, 5.0, 6.0}, {0.4, 0.2, 0.2}, {0, 1, 0}, 0.8};
  if (alpha == AlphaMode::mask) {
    Material holes = scene.materials[scene.instances[1].material];
    holes.alpha_mode = AlphaMode::mask, holes.alpha = 0.0f;
    scene.instances[1].material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(holes);
  }
  return scene;
}

TEST(JudgeContent, WithoutAlphaTestFillsHoles) {
  Captured captured("alpha", board(AlphaMode::mask));
  captured.hold(board());
  expect_label(captured.judged(), Label::ignored_alpha, "alpha mask has holes");
}

TEST(JudgeContent, OfOneSideLacksTheOther) {
  Scene scene = board();
  std::swap(scene.meshes[1].triangles[0][1], scene.meshes[1].triangles[0][2]);
  std::swap(scene.meshes[1].triangles[1][1], scene.meshes[1].triangles[1][2]);  // its back looks at the sun
  for (Material& material : scene.materials) material.double_sided = false;
  Captured captured("culled", scene);
  captured.hold(scene, [](const World& world, const Ray& ray, const raytrace::Hit& hit) {
    return glm::dot(outward_normal(world, hit.primitive, ray.at(hit.t)), ray.direction) < 0.0;
  });
  expect_label(captured.judged(), Label::culled_caster, "was culled");
}

// ---- advice ----

TEST(JudgeAdvice, CountsWhatLiesOutsideTheMap) {
  Captured captured("outside");
  captured.hold(boxes());
  Mat4& matrix = *captured.capture.map[0].clip_from_world;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 2; ++row) matrix[column][row] *= 4.0;
  spoil(captured.capture.map[0].depth, [](ChannelImage& image) {
    const std::vector<float> from = image.channels[0].values;
    const int n = image.size.width, part = n / 4, first = 3 * n / 8;
    image.size = {part, part};
    image.channels[0].values.clear();
    for (int y = first; y < first + part; ++y)
      for (int x = first; x < first + part; ++x)
        image.channels[0].values.push_back(from[std::size_t(y * n + x)]);
  });
  captured.capture.bias->constant_depth = 0.02;
  draw_again(captured.capture, captured.drawn, 0.0f);  // dark beside the map
  const JudgeOutcome judged = captured.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::LightComparison& light = judged.result->lights[0];
  ASSERT_GT(2 * pixels_called(judged, Label::outside_map), light.error.wrong);
  EXPECT_TRUE(judged.result->judged->advice_sought);
  const double outside = double(pixels_called(judged, Label::outside_map)) / double(light.pixels.compared);
  for (const compare::Advice& advice : judged.result->judged->advice) {
    EXPECT_EQ(advice.wrong_now, light.error.wrong_fraction);
    EXPECT_GE(advice.wrong_instead, outside);
  }
  const std::string notes = fmt::format("{}", fmt::join(judged.result->judged->notes, "\n"));
  EXPECT_NE(notes.find("lie outside the map, where no bias changes anything: a window of"), std::string::npos)
      << notes;
  EXPECT_NE(notes.find("or light what lies outside"), std::string::npos) << notes;
  // What is lit there already is not advised to be lit.
  draw_again(captured.capture, captured.drawn, 1.0f);
  const JudgeOutcome lit = captured.judged();
  ASSERT_TRUE(lit.result) << reason(lit);
  ASSERT_GT(2 * pixels_called(lit, Label::outside_map), lit.result->lights[0].error.wrong);
  const std::string of_lit = fmt::format("{}", fmt::join(lit.result->judged->notes, "\n"));
  EXPECT_NE(of_lit.find("lie outside the map, where no bias changes anything: a window of"),
            std::string::npos)
      << of_lit;
  EXPECT_EQ(of_lit.find("light what lies outside"), std::string::npos) << of_lit;
}

TEST(JudgeAdvice, LeavesAConstantBelowZeroThatIsRight) {
  Captured captured("negative");
  captured.capture.bias->constant_depth = -0.55 / captured.range();
  captured.hold(boxes(), 0.6);
  const JudgeOutcome judged = captured.judged();
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_TRUE(judged.result->judged->advice_sought);
  for (const compare::Advice& advice : judged.result->judged->advice)
    EXPECT_NE(advice.setting, "bias.constant_depth") << "it stays";
}

}  // namespace
}  // namespace gnomon::test
