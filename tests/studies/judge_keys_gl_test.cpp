// Every key of a capture, right and with one fault: where all is said as it was drawn, the test that the capture describes
// draws its picture; with the fault the verdict names the key. The picture is another renderer's (other_renderer.cpp), written
// with nothing but the capture.
#include "tests/support/said_keys.h"

namespace gnomon::test {
namespace {

using judge::BiasAngle;
using judge::FilterName;
using judge::StoredDepth;
using Read = judge::FilterRead;
using raster::Technique;

/// What an Engine is made with.
struct Drawing {
  const char* light = "sun";
  StoredDepth stored = StoredDepth::zero_to_one;
  double constant = 0.002;
  double caster_constant = 0.0, caster_slope = 0.0;
};

struct KeyCase {
  const char* name;
  Drawing drawing;
  std::function<void(Engine&)> say;     ///< what is drawn and said
  std::function<void(Capture&)> fault;  ///< what is said otherwise
  const char* named;                    ///< words of the verdict on that
};

void shift_matrix(Capture& capture, double texels) {
  Mat4 shifted(1.0);
  shifted[3][0] = 2.0 * texels / 512.0;
  *capture.map[0].clip_from_world = shifted * *capture.map[0].clip_from_world;
}

void to_texture(Capture& capture) {
  Mat4 texture_from_clip(1.0);
  for (int i = 0; i < 2; ++i) texture_from_clip[i][i] = 0.5, texture_from_clip[3][i] = 0.5;
  *capture.map[0].clip_from_world = texture_from_clip * *capture.map[0].clip_from_world;
}

// ---- faults ----

void nothing(Engine&) {}
void turn_rows(Capture& c) {
  for (judge::CapturedLayer& layer : c.map)
    layer.rows =
        layer.rows == judge::RowOrder::top_down ? judge::RowOrder::bottom_up : judge::RowOrder::top_down;
}
void turn_sign(Capture& c) {
  c.bias->constant_depth = -c.bias->constant_depth;
}
std::function<void(Capture&)> stored_as(StoredDepth stored) {
  return [=](Capture& c) {
    for (judge::CapturedLayer& layer : c.map) layer.convention = stored;
  };
}
std::function<void(Capture&)> said_bias(const CapturedBias& bias) {
  return [=](Capture& c) { c.bias = bias; };
}
void other_measure(Capture& c) {
  for (judge::CapturedLayer& layer : c.map) layer.select->by_distance = !layer.select->by_distance;
}
void no_layer_bias(Capture& c) {
  for (judge::CapturedLayer& layer : c.map) layer.bias.reset();
}

void no_reduction(Capture& c) {
  c.filter->light_bleeding_reduction = 0.0;
}
void other_exponent(Capture& c) {
  c.filter->exponents[0] *= 1.5;
}

const char* const rows_words = "`rows` of the map is the other one";
const char* const sign_words = "`constant_depth` has the other sign";
const Drawing lamp{.light = "lamp", .constant = 0.0004};
const Drawing lamp_distance{.light = "lamp", .stored = StoredDepth::distance, .constant = 0.02};
const Drawing lamp_far{.light = "lamp", .stored = StoredDepth::distance, .constant = 0.15};
const Drawing lamp_linear{.light = "lamp", .stored = StoredDepth::linear_z, .constant = 0.02};
const Drawing bulb{.light = "bulb", .stored = StoredDepth::distance, .constant = 0.02};
const Drawing wide{.constant = 0.03};
// So little that some acne stays, which no other constant draws.
const CapturedBias sine{.constant_depth = 0.006, .angle = BiasAngle::sine};
const CapturedBias tangent{.constant_depth = 0.005, .angle = BiasAngle::tangent, .min = 0.0001, .max = 2.0};
const CapturedBias haversine{.constant_depth = 0.02, .angle = BiasAngle::one_minus_cosine, .min = 0.0001};
const CapturedBias plain{.constant_depth = 0.3};
const CapturedBias offset_sine{
    .constant_depth = 0.02, .normal_offset_world = 0.2, .normal_offset_angle = BiasAngle::sine};
const CapturedBias offset_haversine{
    .constant_depth = 0.02, .normal_offset_world = 0.6, .normal_offset_angle = BiasAngle::one_minus_cosine};
const CapturedBias offset{.constant_depth = 0.02, .normal_offset_world = 0.2};

const KeyCase key_cases[] = {
    // conventions
    {"rows", {}, nothing, turn_rows, rows_words},
    {"reversed", {.stored = StoredDepth::reversed}, nothing, turn_rows, rows_words},
    {"minus_one",
     {.stored = StoredDepth::minus_one_to_one},
     nothing,
     stored_as(StoredDepth::zero_to_one),
     "`minus_one_to_one`"},
    {"zero_to_one", {}, nothing, stored_as(StoredDepth::minus_one_to_one), "`zero_to_one`"},
    {"lamp", lamp, nothing, turn_rows, rows_words},
    {"lamp_reversed",
     {.light = "lamp", .stored = StoredDepth::reversed, .constant = 0.0004},
     nothing,
     turn_rows,
     rows_words},
    // Another constant draws these but for a pixel, and is the plainer cause.
    {"distance", lamp_far, nothing, stored_as(StoredDepth::linear_z), "`constant_depth` is about 0.08"},
    {"distance_range", lamp_far, in_range(1.0, 20.0), stored_as(StoredDepth::linear_z),
     "`constant_depth` is about 0.004"},
    {"linear_z", lamp_linear, nothing, stored_as(StoredDepth::distance),
     "`convention` of the map is linear_z"},
    {"linear_range", lamp_linear, in_range(20.0, 1.0), turn_sign, sign_words},
    {"cube", bulb, nothing, turn_sign, sign_words},
    {"cube_range", bulb, in_range(0.5, 40.0), turn_sign, sign_words},
    {"paraboloids", bulb, as_paraboloids({512, 512}, false), turn_sign, sign_words},
    {"paraboloids_rows", bulb, as_paraboloids({512, 512}, false), turn_rows, rows_words},
    {"paraboloids_exchanged", bulb, as_paraboloids({600, 300}, false),
     [](Capture& c) { std::swap(c.map[0].depth, c.map[1].depth); },
     "the pictures of map[0] and map[1] are exchanged"},
    {"paraboloids_fade", bulb,
     [](Engine& e) {
       as_paraboloids({512, 512}, false)(e);
       faded({4.8, 5.2, false})(e);
     },
     [](Capture& c) { c.fade.reset(); }, "world units along the view's axis (`fade`)"},
    {"cube_layer_bias", bulb,
     [](Engine& e) {
       for (judge::CapturedLayer& layer : e.capture.map) layer.bias = e.capture.bias;
       e.capture.map[3].bias->constant_depth = 0.4;  // the floor's
     },
     no_layer_bias, "`constant_depth` is about 0.4"},
    {"paraboloids_range", bulb,
     [](Engine& e) {
       as_paraboloids({512, 256}, true)(e);
       in_range(0.0, 40.0)(e);
     },
     said_bias({}), "`constant_depth` is about"},
    {"texture_matrix",
     {},
     nothing,
     to_texture,
     "`clip_from_world` holds the scale and shift to texture coordinates"},
    {"half_texel", {}, nothing, [](Capture& c) { shift_matrix(c, 0.5); }, "0.5, 0 texels off"},
    // the bias
    {"constant", wide, nothing, said_bias({}), "`constant_depth` is about 0.03"},
    {"sign", {}, nothing, turn_sign, sign_words},
    {"sine", lamp_distance, with_bias(sine), [](Capture& c) { c.bias->angle = BiasAngle::none; },
     "`bias.angle` is sine"},
    {"tangent", lamp_distance, with_bias(tangent), [](Capture& c) { c.bias->angle = BiasAngle::none; },
     "`bias.angle` is tangent"},
    {"haversine", lamp_distance, with_bias(haversine), [](Capture& c) { c.bias->angle = BiasAngle::none; },
     "`bias.angle` is one_minus_cosine"},
    {"no_angle", lamp_distance, with_bias(plain),
     [](Capture& c) { c.bias->angle = BiasAngle::one_minus_cosine; }, "`bias.angle` is none"},
    {"limits", lamp_distance, with_bias(plain), [](Capture& c) { c.bias->max = 0.05; },
     "nothing limits the bias (`bias.min`, `bias.max`)"},
    {"offset", lamp_distance, with_bias(offset),
     [](Capture& c) { c.bias->normal_offset_angle = BiasAngle::sine; }, "`bias.normal_offset_angle` is none"},
    {"offset_sine", lamp_distance, with_bias(offset_sine), said_bias(offset),
     "`bias.normal_offset_angle` is sine"},
    {"offset_haversine", lamp_distance, with_bias(offset_haversine),
     [](Capture& c) { c.bias->normal_offset_angle = BiasAngle::none; },
     "`bias.normal_offset_angle` is one_minus_cosine"},
    {"no_offset", lamp_distance, nothing, said_bias(offset), "no offset along the normal is drawn"},
    {"caster_constant",
     {.constant = 0.0, .caster_constant = 0.4},
     nothing,
     [](Capture&) {},
     "the map was drawn with "},
    {"caster_slope",
     {.constant = 0.0, .caster_slope = 32.0},
     nothing,
     [](Capture&) {},
     "the map was drawn with "},
    // layers
    {"select", {}, selected(false), other_measure, "layers are chosen by view_z (`select.by`)"},
    {"select_distance", {}, selected(true), other_measure, "layers are chosen by distance (`select.by`)"},
    {"blend", {}, selected(true, 0.2), other_measure, "layers are chosen by distance (`select.by`)"},
    {"by_place",
     {},
     nothing,
     [](Capture& c) { select_three(c, false), no_layer_bias(c), c.map.resize(2); },
     "(no `select`)"},
    {"layer_bias", {}, selected(false), no_layer_bias, "`map[1].bias.constant_depth` is about 0.0"},
    {"no_layer_bias",
     {},
     [](Engine& e) { select_three(e.capture, false), no_layer_bias(e.capture); },
     [](Capture& c) { c.map[1].bias = CapturedBias{.constant_depth = 0.05}; },
     "(`map[].bias`) are not drawn"},
    {"nine_layers",
     {},
     [](Engine& e) { cut_into(e.capture, 3, 6); },
     [](Capture& c) { std::swap(c.map[3].depth, c.map[4].depth); },
     "the pictures of map[3] and map[4] are exchanged"},
    {"sixteen_layers", {}, [](Engine& e) { cut_into(e.capture, 4, 6); }, turn_rows, rows_words},
    {"atlas",
     {},
     [](Engine& e) {
       put_into_atlas(e, {512, 100, 512, 512}, {1024, 700});
     },
     [](Capture& c) {
       Mat4 rect_from_atlas(1.0);
       rect_from_atlas[0][0] = 2.0, rect_from_atlas[3][0] = -1.0;
       rect_from_atlas[1][1] = 700.0 / 512,
       rect_from_atlas[3][1] = -(2.0 * (100 + 256) / 700 - 1.0) * 700 / 512;
       *c.map[0].clip_from_world = rect_from_atlas * *c.map[0].clip_from_world;
     },
     "`clip_from_world` is that of the layer alone"},
    {"atlas_lamp", lamp,
     [](Engine& e) {
       put_into_atlas(e, {512, 100, 512, 512}, {1024, 700});
     },
     turn_rows, "`rows` says at which end its y begins"},
    {"strip", {}, cut_to_strip, turn_sign, sign_words},
    // how it is read and drawn
    {"linear_depths",
     {},
     [](Engine& e) { e.capture.filter = judge::CapturedFilter{.read = Read::linear_depths}; },
     [](Capture& c) { c.filter->read = Read::nearest; },
     "`filter.read` is linear_depths"},
    {"nearest",
     {},
     nothing,
     [](Capture& c) { c.filter = judge::CapturedFilter{.read = Read::linear_depths}; },
     "`filter.read` is nearest"},
    // moments
    {"vsm",
     {},
     filtered({.kind = FilterName::vsm, .light_bleeding_reduction = 0.3}),
     no_reduction,
     "`filter.light_bleeding_reduction` is about 0.3"},
    {"vsm_variance",
     {},
     filtered({.kind = FilterName::vsm, .minimum_variance = 1e-3}),
     [](Capture& c) { c.filter->minimum_variance = 0.0; },
     "`filter.minimum_variance` is about 0.001"},
    {"esm",
     {},
     filtered({.kind = FilterName::esm, .exponents = {80.0}}),
     other_exponent,
     "`filter.exponents` are about [80]"},
    {"evsm_two",
     {},
     filtered({.kind = FilterName::evsm, .exponents = {20.0}}),
     other_exponent,
     "`filter.exponents` are about [20]"},
    {"evsm_four",
     {.stored = StoredDepth::minus_one_to_one},
     filtered({.kind = FilterName::evsm, .exponents = {40.0, 5.0}, .light_bleeding_reduction = 0.1}),
     other_exponent,
     "`filter.exponents` are about [40, 5]"},
    {"msm", {}, filtered({.kind = FilterName::msm, .moment_bias = 3e-5}), turn_rows, rows_words},
    {"vsm_lamp", lamp_linear,
     [](Engine& e) {
       in_range(0.5, 20.0)(e);
       filtered({.kind = FilterName::vsm})(e);
     },
     turn_sign, sign_words},
    {"msm_distance", lamp_far,
     [](Engine& e) {
       in_range(0.5, 20.0)(e);
       filtered({.kind = FilterName::msm})(e);
     },
     turn_sign, sign_words},
    {"fade",
     {},
     faded({4.8, 5.2, false}),
     [](Capture& c) { c.fade.reset(); },
     "world units along the view's axis (`fade`)"},
    {"fade_distance",
     {},
     faded({5.0, 5.0, true}),
     [](Capture& c) { c.fade.reset(); },
     "world units from the eye (`fade`)"},
    {"no_fade",
     {},
     nothing,
     [](Capture& c) {
       c.fade = CapturedFade{4.8, 5.2, false};
     },
     "shadows do not end (`fade`)"},
    {"strength",
     {},
     [](Engine& e) { e.capture.strength = 0.5; },
     [](Capture& c) { c.strength.reset(); },
     "a strength of 0.5"},
    {"strength_more",
     {},
     [](Engine& e) { e.capture.strength = 0.5; },
     [](Capture& c) { c.strength = 0.8; },
     "`strength` is 0.5 (got 0.8)"},
    {"strength_less",
     {},
     [](Engine& e) { e.capture.strength = 0.8; },
     [](Capture& c) { c.strength = 0.5; },
     "`strength` is more than 0.5"},
    {"also", {}, darken_by_another, [](Capture& c) { c.also.clear(); }, "is said by `also`"},
};

class JudgeEveryKey : public testing::TestWithParam<KeyCase> {};

TEST_P(JudgeEveryKey, IsReadAndItsFaultNamed) {
  const KeyCase& c = GetParam();
  const Drawing& d = c.drawing;
  raster::Bias casters{.slope = 0.0};
  casters.caster_constant = d.caster_constant, casters.caster_slope = d.caster_slope;
  Engine engine(std::string("keys-") + c.name, d.constant, d.light, d.stored, casters);
  c.say(engine);
  draw_again(engine.capture, engine.drawn);
  draw_with_also(engine);
  const JudgeOutcome right = engine.judged();
  ASSERT_TRUE(right.result) << reason(right);
  EXPECT_GT(right.result->judged->biased_is_drawn, 0.999) << notes_in(right);
  const auto unexplained =
      right.result->lights[0].classes[static_cast<std::size_t>(compare::Label::unexplained) - 1];
  EXPECT_EQ(unexplained, 0U) << notes_in(right);
  if (d.caster_constant == 0.0 && d.caster_slope == 0.0) {
    EXPECT_EQ(notes_in(right).find(c.named), std::string::npos) << notes_in(right);
  }
  c.fault(engine.capture);
  const JudgeOutcome faulty = engine.judged();
  EXPECT_NE(notes_in(faulty).find(c.named), std::string::npos) << notes_in(faulty);
}

INSTANTIATE_TEST_SUITE_P(Keys, JudgeEveryKey, testing::ValuesIn(key_cases),
                         [](const auto& chosen) { return chosen.param.name; });

// Which face of a cube is looked up is no distance's to say.
TEST(JudgeEveryKeyOfCubes, HasNoSelect) {
  Engine engine("keys-cube-select", bulb.constant, bulb.light, bulb.stored);
  for (judge::CapturedLayer& layer : engine.capture.map) layer.select = CapturedSelect{0.0, 9.0};
  EXPECT_NE(reason(engine.judged()).find("map[0].select: is not of a cube"), std::string::npos);
}

// The filter's picture is Gnomon's own.
TEST(JudgeEveryKeyOfFilters, NamesAFilterThatIsNotSaid) {
  raster::MapOptions map = Engine::map_with({.slope = 1.0}, Technique::pcf);
  map.filter.radius_texels = 5.5;
  const Compared drawn = draw_scene(hovering_box("sun"), small_picture, map);
  Capture capture = self_capture(drawn, folder_for("keys-pcf"), {.map = true});
  for (const double radius : {5.5, 0.0}) {
    capture.filter =
        radius > 0.0 ? judge::CapturedFilter{judge::FilterName::pcf, radius} : judge::CapturedFilter{};
    const JudgeOutcome judged = judge(capture, *drawn.scene);
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_EQ(notes_in(judged).find("(`filter.kind` pcf, `filter.radius_texels` 5.5)") != std::string::npos,
              radius == 0.0)
        << notes_in(judged);
  }
}

}  // namespace
}  // namespace gnomon::test
