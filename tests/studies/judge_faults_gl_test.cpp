// Random captures, each with one fault whose pixels are known: those that are wrong, and right once the fault is taken away.
// What they are called is the table of docs/labels.md, which GNOMON_FAULTS_FILE=docs/labels.md in the environment writes there;
// GNOMON_FAULTS=N draws N captures of each fault.
#include <fmt/ranges.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>

#include "compare/ladder/labels.h"
#include "compare/truth/columns.h"
#include "judge/moments.h"
#include "judge/stored_format.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {
namespace {

using compare::Label;
using judge::Capture;
using judge::StoredDepth;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * unit_(engine_); }
  bool coin() { return between(0.0, 1.0) < 0.5; }
  std::size_t below(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(between(0.0, double(n))));
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

constexpr double half_side = 5.0;

/// A floor and five boxes, some of them in the air, under a sun; with `card` a board whose mask has holes.
Scene random_scene(Dice& dice, bool card) {
  std::vector<Mesh> meshes{floor_mesh(half_side, half_side)};
  for (int k = 0; k < 5; ++k) {
    const Vec3 low(dice.between(-3.0, 2.2), dice.coin() ? 0.0 : dice.between(0.2, 1.2),
                   dice.between(-3.0, 2.2));
    const Vec3 size(dice.between(0.4, 1.2), dice.between(0.4, 1.3), dice.between(0.4, 1.2));
    meshes.push_back(box_mesh(low, low + size));
    meshes.back().name = fmt::format("box {}", k);
  }
  Mesh board;
  board.name = "board";
  const double y = dice.between(1.2, 2.0), tilt = dice.between(-0.3, 0.3), x = dice.between(-2.0, 0.0);
  board.positions = {{x, y, -1.5}, {x, y + tilt, 1.5}, {x + 2.5, y + tilt, 1.5}, {x + 2.5, y, -1.5}};
  board.uvs = {{0.0f, 0.0f}, {0.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}};
  board.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (card) meshes.push_back(board);
  Scene scene = sunlit_scene(std::move(meshes), {dice.between(-0.7, 0.7), -1.0, dice.between(-0.7, 0.7)});
  if (card) {
    Texture holes{"holes", {8, 8}, {}, true, true, false, false};
    for (int k = 0; k < 64; ++k)
      holes.texels.emplace_back(200, 200, 200,
                                dice.between(0.0, 1.0) < 0.55 ? std::uint8_t{0} : std::uint8_t{255});
    scene.textures.push_back(holes);
    Material leaf = scene.materials[scene.instances.back().material];
    leaf.alpha_mode = AlphaMode::mask,
    leaf.diffuse_texture = static_cast<std::uint32_t>(scene.textures.size() - 1);
    scene.instances.back().material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(leaf);
  }
  const double turn = dice.between(0.0, 2.0 * pi);
  scene.camera = {
      {6.5 * std::cos(turn), dice.between(3.0, 5.0), 6.5 * std::sin(turn)}, {0.0, 0.4, 0.0}, {0, 1, 0}, 0.8};
  return scene;
}

/// What a texel's ray meets first, in the map's own numbers: 0 at the near plane and 1 at the far one.
struct Met {
  double depth = 0.0, slope = 0.0;  ///< slope: the larger change from texel to texel
};
/// The number that the map stores for it, or for nothing.
using Numbers = std::function<double(const std::optional<Met>&)>;

double as_it_is(const std::optional<Met>& met) {
  return met ? met->depth : 1.0;
}

/// A capture, and the map and picture that its renderer makes of a scene.
class Renderer {
 public:
  Renderer(Scene scene, Dice& dice)
      : drawn_(draw_scene(std::move(scene), {176, 132}, hard_map(192))),
        capture_(self_capture(
            drawn_, folder_for("faults"),
            {.map = true,
             .stored = dice.coin() ? StoredDepth::zero_to_one : StoredDepth::minus_one_to_one})) {
    capture_.bias =
        judge::CapturedBias{.constant_depth = 0.006, .normal_offset_world = dice.coin() ? 0.0 : 0.04};
  }
  const Scene& scene() const { return *drawn_.scene; }
  const LightView& view() const { return drawn_.result.raster.lights[0].map.view; }
  Capture& capture() { return capture_; }

  void draw_map(const Scene& scene, const Numbers& numbers) {
    const World world = make_world(scene);
    const raytrace::Tracer tracer(world, raytrace::Accel::bvh);
    spoil(capture_.map[0].depth, [&](ChannelImage& image) {
      const int n = view().size;
      for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column)
          image.channels[0].values[std::size_t(row * n + column)] =
              static_cast<float>(std::clamp(nearest(world, tracer, column, row, numbers), 0.0, 1.0));
    });
  }
  void change_map(const std::function<void(std::vector<float>&, int)>& change) {
    spoil(capture_.map[0].depth,
          [&](ChannelImage& image) { change(image.channels[0].values, image.size.width); });
  }
  void change_picture_of_map(const Spoil& change) { spoil(capture_.map[0].depth, change); }
  /// What the renderer draws on the map that there is.
  std::vector<float> draw() {
    draw_again(capture_, drawn_);
    return read_channels(capture_.visibility)->channels[0].values;
  }
  void change_picture(const std::function<float(const Vec3&, float)>& change) {
    spoil(capture_.visibility, [&](ChannelImage& image) {
      std::vector<float>& values = image.channels[0].values;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const raytrace::SurfacePoint& point = drawn_.result.raytraced.receiver.data[i];
        if (point.primitive != no_id && drawn_.light().labels.data[i] != Label::facing_away)
          values[i] = change(point.position, values[i]);
      }
    });
  }
  /// The number of a place, in whatever range the map has.
  double number_of(const Vec3& place) const {
    const Vec4 clip = *capture_.map[0].clip_from_world * Vec4(place, 1.0);
    return capture_.map[0].convention == StoredDepth::minus_one_to_one ? 0.5 * clip.z + 0.5 : clip.z;
  }
  /// Makes the map's far plane stand at this number of the present ones.
  void move_far_plane(double at) {
    Mat4& matrix = *capture_.map[0].clip_from_world;
    const bool halves = capture_.map[0].convention == StoredDepth::minus_one_to_one;
    for (int column = 0; column < 4; ++column) {
      const double w = matrix[column][3], z = halves ? 0.5 * (matrix[column][2] + w) : matrix[column][2];
      matrix[column][2] = halves ? 2.0 * z / at - w : z / at;
    }
    capture_.bias->constant_depth /= at;
    change_map([at](std::vector<float>& values, int) {
      for (float& v : values) v = v < at ? static_cast<float>(double{v} / at) : 1.0f;
    });
  }
  JudgeOutcome judged() const { return judge(capture_, *drawn_.scene); }

  std::vector<float> sound;  ///< the picture without the fault

 private:
  /// The nearest of the numbers of all that the texel's ray meets, as a depth test keeps it.
  double nearest(const World& world, const raytrace::Tracer& tracer, int column, int row,
                 const Numbers& numbers) const {
    const Ray ray = compare::caster_ray(world, view(), 0, column + 0.5, row + 0.5);
    double least = numbers(std::nullopt);
    compare::visit_hits(
        ray, [&](const Ray& rest) { return tracer.closest_hit(rest, raytrace::Sides::casting); },
        [&](const raytrace::Hit& hit) {
          least = std::min(least, numbers(met_by(world, ray, hit)));
          return true;
        });
    return least;
  }
  Met met_by(const World& world, const Ray& ray, const raytrace::Hit& hit) const {
    const LightFace& face = view().face(0);
    const double range = face.far_depth - face.near_depth;
    const Vec3 normal = outward_normal(world, hit.primitive, ray.at(hit.t));
    const Vec2 texel = 2.0 * face.half_extent / double(view().size);
    const double facing = std::abs(glm::dot(normal, face.forward));
    const double u = std::abs(glm::dot(normal, face.right)) * texel.x,
                 v = std::abs(glm::dot(normal, face.up)) * texel.y;
    return {(glm::dot(ray.at(hit.t) - view().origin, face.forward) - face.near_depth) / range,
            std::max(u, v) / std::max(1e-6, facing) / range};
  }

  Compared drawn_;
  Capture capture_;
};

struct Fault {
  std::string name;
  Label label;
  bool card = false;
  /// Makes the fault of a capture whose map holds the scene.
  std::function<void(Renderer&, Dice&)> make;
  double recall = 0.95;
  std::string words;  ///< of a note
};

Scene opaque(Scene scene) {
  for (Material& m : scene.materials) m.alpha_mode = AlphaMode::opaque;
  return scene;
}

void make_missing(Renderer& r, Dice& dice) {
  Scene scene = r.scene();
  scene.instances.erase(scene.instances.begin() + 1 + std::ptrdiff_t(dice.below(5)));
  r.draw_map(scene, as_it_is), r.draw();
}

void make_moved(Renderer& r, Dice& dice) {
  Scene scene = r.scene();
  const Vec3 by(dice.between(-1.5, 1.5), dice.coin() ? 0.0 : dice.between(-0.4, 0.6),
                dice.between(-1.5, 1.5));
  for (Vec3& p : scene.meshes[1 + dice.below(5)].positions) p += by;
  r.draw_map(scene, as_it_is), r.draw();
}

/// Takes away what else keeps acne away, so that the casters' bias is what the picture has.
void make_offset(Renderer& r, double constant, double slope) {
  r.draw_map(r.scene(), [=](const std::optional<Met>& met) {
    return met ? met->depth + constant + slope * met->slope : 1.0;
  });
  r.draw();
}

template <class Round>
void round_map(Renderer& r, const Round& round) {
  r.change_map([&](std::vector<float>& values, int) {
    for (float& v : values) v = v < 1.0f ? static_cast<float>(round(double{v})) : 1.0f;
  });
  r.draw();
}

/// Turns the map's texels: columns, rows and their exchange.
void turn_map(Renderer& r, bool columns, bool rows, bool transposed) {
  r.change_map([=](std::vector<float>& values, int n) {
    const std::vector<float> from = values;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        int u = transposed ? y : x, v = transposed ? x : y;
        u = columns ? n - 1 - u : u, v = rows ? n - 1 - v : v;
        values[std::size_t(y * n + x)] = from[std::size_t(v * n + u)];
      }
  });
  r.draw();
}

/// A layer of the middle of the scene beside another one, whose texels are near, in one picture; 3 x 3 comparisons read beyond it.
void make_neighbours(Renderer& r, Dice&) {
  const int n = r.view().size / 2;
  Mat4& matrix = *r.capture().map[0].clip_from_world;
  for (int column = 0; column < 4; ++column) matrix[column][0] *= 2.0, matrix[column][1] *= 2.0;
  std::vector<float> own;
  r.change_picture_of_map([&](ChannelImage& image) {
    const std::vector<float> from = image.channels[0].values;
    std::vector<float>& to = image.channels[0].values;
    to.assign(std::size_t(2 * n * n), 0.1f), image.size = {2 * n, n};
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const float v = from[std::size_t((y + n / 2) * 2 * n + x + n / 2)];
        to[std::size_t(y * 2 * n + x)] = v, own.push_back(v);
      }
  });
  const Mat4 layer = matrix;
  for (int column = 0; column < 4; ++column) matrix[column][0] = 0.5 * (layer[column][0] - layer[column][3]);
  r.capture().map[0].rect = judge::CapturedRect{0, 0, n, n};
  r.capture().filter = judge::CapturedFilter{.kind = judge::FilterName::pcf, .radius_texels = 1.5};
  r.capture().bias->normal_offset_world = 0.0;
  const bool halves = r.capture().map[0].convention == StoredDepth::minus_one_to_one;
  const double bias = r.capture().bias->constant_depth;
  const auto filtered = [&](const Vec3& place, bool clamps) {
    const Vec3 clip(layer * Vec4(place, 1.0));
    const double u = (0.5 * clip.x + 0.5) * n, v = (0.5 * clip.y + 0.5) * n,
                 z = halves ? 0.5 * clip.z + 0.5 : clip.z;
    if (u < 0.0 || v < 0.0 || u >= n || v >= n) return 1.0f;
    float lit = 0.0f;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const int x = int(u) + i, y = std::clamp(int(v) + j, 0, n - 1);
        const bool beyond = x >= n && !clamps;
        lit += z - bias > double{beyond ? 0.1f : own[std::size_t(y * n + std::clamp(x, 0, n - 1))]} ? 0.0f
                                                                                                    : 1.0f;
      }
    return lit / 9.0f;
  };
  r.draw();
  r.change_picture([&](const Vec3& place, float) { return filtered(place, true); });
  r.sound = read_channels(r.capture().visibility)->channels[0].values;
  r.change_picture([&](const Vec3& place, float) { return filtered(place, false); });
}

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      {"a box is missing", Label::missing_caster, false, make_missing, 0.99, "missing from the map"},
      {"a box moved", Label::moved_caster, false, make_moved, 0.95, "stands elsewhere"},
      {"casters offset by a constant", Label::caster_bias, false,
       [](Renderer& r, Dice& dice) { make_offset(r, dice.between(0.02, 0.2), 0.0); }, 0.95, "was drawn with"},
      {"casters offset by their slope", Label::caster_bias, false,
       [](Renderer& r, Dice& dice) { make_offset(r, 0.0, dice.between(2.0, 40.0)); }, 0.95, "was drawn with"},
      {"casters offset by both", Label::caster_bias, false,
       [](Renderer& r, Dice& dice) { make_offset(r, dice.between(0.01, 0.1), dice.between(1.0, 8.0)); }, 0.95,
       "was drawn with"},
      {"alpha is ignored", Label::ignored_alpha, true,
       [](Renderer& r, Dice&) { r.draw_map(opaque(r.scene()), as_it_is), r.draw(); }, 0.95,
       "alpha mask has holes"},
      {"eight bits, truncated", Label::stored_depth, false,
       [](Renderer& r, Dice&) { round_map(r, [](double v) { return std::floor(255.0 * v) / 255.0; }); }, 0.95,
       "multiples of 1/255: eight bits"},
      {"eight bits, rounded", Label::stored_depth, false,
       [](Renderer& r, Dice&) { round_map(r, [](double v) { return std::round(255.0 * v) / 255.0; }); }, 0.95,
       "multiples of 1/255: eight bits"},
      {"mirrored", Label::unexplained, false, [](Renderer& r, Dice&) { turn_map(r, true, false, false); },
       0.95, "mirrored left to right"},
      {"upside down", Label::unexplained, false, [](Renderer& r, Dice&) { turn_map(r, false, true, false); },
       0.95, "upside down for its reader"},
      {"columns for rows", Label::unexplained, false,
       [](Renderer& r, Dice&) { turn_map(r, false, false, true); }, 0.95, "its columns for its rows"},
      {"a filter that reads its neighbour", Label::outside_map, false, make_neighbours, 0.95,
       "beyond its layer's part of the atlas"},
      {"dark behind the far plane", Label::outside_map, false,
       [](Renderer& r, Dice& dice) {
         r.move_far_plane(dice.between(0.55, 0.75));
         r.draw();
         const double end = 1.0 + r.capture().bias->constant_depth;
         r.change_picture([&](const Vec3& p, float v) { return r.number_of(p) > end ? 0.0f : v; });
       },
       0.95, "behind the map's far plane and are drawn dark"},
      {"lit behind the far plane", Label::outside_map, false,
       [](Renderer& r, Dice& dice) {
         r.move_far_plane(dice.between(0.55, 0.75));
         r.draw();
         r.change_picture([&](const Vec3& p, float v) { return r.number_of(p) > 1.0 ? 1.0f : v; });
       },
       0.95, "behind the map's far plane and are drawn lit"},
  };
  return all;
}

/// What the pixels of one fault are called.
struct Row {
  std::array<std::uint64_t, compare::class_count> named{};
  std::size_t captures = 0, said = 0;
  std::uint64_t all() const { return std::accumulate(named.begin(), named.end(), std::uint64_t{0}); }
  double recall(Label label) const {
    return double(named[static_cast<std::size_t>(label) - 1]) / double(std::max<std::uint64_t>(1, all()));
  }
};

void expect_exact_sums(const compare::LightComparison& light) {
  double steps = 0.0, wrong = 0.0, signed_sum = 0.0;
  for (const compare::BudgetStep& step : light.budget)
    steps += double(step.false_shadow + step.missed_shadow), signed_sum += step.signed_mean;
  for (const std::uint64_t n : light.classes) wrong += double(n);
  EXPECT_EQ(steps, double(light.error.wrong));
  EXPECT_EQ(wrong, double(light.error.wrong));
  double error = 0.0, count = 0.0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i)
    if (compare::is_compared(light.labels.data[i]))
      error += double{light.rungs[6].data[i]} - double{light.rungs[0].data[i]}, count += 1.0;
  EXPECT_NEAR(signed_sum, error / count, 1e-12);
}

void judge_fault(const Fault& fault, std::uint64_t seed, Row& row) {
  Dice dice(seed);
  Renderer renderer(random_scene(dice, fault.card), dice);
  renderer.draw_map(renderer.scene(), as_it_is);
  renderer.sound = renderer.draw();
  fault.make(renderer, dice);
  const std::vector<float>& sound = renderer.sound;
  const JudgeOutcome judged = renderer.judged();
  ASSERT_TRUE(judged.result) << fault.name << ", " << seed << ": " << reason(judged);
  const compare::LightComparison& light = judged.result->lights[0];
  expect_exact_sums(light);
  std::array<std::uint64_t, compare::class_count> named{};
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const Label label = light.labels.data[i];
    if (!compare::has_cause(label) || !compare::is_wrong(compare::rungs_at(light.rungs, i))) continue;
    // One that the texel's centre has wrong was right by accident (docs/labels.md).
    const bool by_accident = std::abs(light.rungs[2].data[i] - light.rungs[0].data[i]) > 0.5f;
    if (by_accident && label != Label::outside_map) continue;
    if (std::abs(sound[i] - light.rungs[0].data[i]) <= 0.5f) ++named[static_cast<std::size_t>(label) - 1];
  }
  const std::uint64_t all = std::accumulate(named.begin(), named.end(), std::uint64_t{0});
  constexpr std::uint64_t few = 20;  // of which notes need not speak
  if (all < few) return;
  const std::string notes = fmt::format("{}", fmt::join(judged.result->judged->notes, "\n"));
  ++row.captures, row.said += notes.find(fault.words) != std::string::npos ? 1 : 0;
  for (std::size_t k = 0; k < named.size(); ++k) row.named[k] += named[k];
  if (std::getenv("GNOMON_FAULTS") != nullptr) {
    std::string text;
    for (std::size_t k = 0; k < named.size(); ++k)
      if (named[k] > 0)
        text += fmt::format(" {} {}", named[k], compare::label_name(static_cast<Label>(k + 1)));
    fmt::print("{}, {}:{}\n{}\n", fault.name, seed, text, notes);
  }
}

TEST(JudgeFaults, AreNamedInRandomCaptures) {
  const char* asked = std::getenv("GNOMON_FAULTS");
  const int captures = asked != nullptr ? std::atoi(asked) : 2;
  const char* only = std::getenv("GNOMON_FAULT");
  std::string table;
  for (const Fault& fault : faults()) {
    if (only != nullptr && fault.name.find(only) == std::string::npos) continue;
    Row row;
    for (int k = 0; k < captures; ++k) judge_fault(fault, 1000 + std::uint64_t(k), row);
    std::string others;
    for (std::size_t k = 0; k < row.named.size(); ++k)
      if (row.named[k] > 0 && static_cast<Label>(k + 1) != fault.label)
        others += fmt::format("{}{} {}", others.empty() ? "" : ", ", row.named[k],
                              compare::label_text(static_cast<Label>(k + 1)).name);
    table += fmt::format("| {} | {} | {} | {:.1f} % | {} | {} of {} |\n", fault.name,
                         compare::label_text(fault.label).name, row.all(), 100.0 * row.recall(fault.label),
                         others, row.said, row.captures);
    EXPECT_TRUE(row.all() == 0 || row.recall(fault.label) >= fault.recall) << fault.name << ": " << others;
    EXPECT_GT(row.captures, 0U) << fault.name;
    EXPECT_EQ(row.said, row.captures) << fault.name;
  }
  const std::string text =
      "| fault | label | pixels | so called | others | said |\n|---|---|--:|--:|---|--:|\n" + table +
      fmt::format("\n{} random captures of each fault.\n", captures);
  fmt::print("{}", text);
  if (const char* path = std::getenv("GNOMON_FAULTS_FILE"))
    write_between_marks(path, "table of faults", text);
}

std::string notes_of_judged(const JudgeOutcome& judged) {
  return judged.result ? fmt::format("{}", fmt::join(judged.result->judged->notes, "\n")) : reason(judged);
}

// Averages of depths lie behind the nearest of them, which is no offset of casters.
TEST(JudgeFaults, AreNoneOfASoundMapNorOfItsMoments) {
  using judge::FilterName;
  const judge::CapturedFilter filters[] = {
      {},
      {.kind = FilterName::esm, .radius_texels = 2.5, .exponents = {40.0}},
      {.kind = FilterName::evsm, .radius_texels = 2.5, .exponents = {15.0}}};
  for (const judge::CapturedFilter& filter : filters) {
    Dice dice(7);
    Renderer renderer(random_scene(dice, true), dice);
    renderer.draw_map(renderer.scene(), as_it_is);
    renderer.capture().filter = filter;
    if (filter.kind != FilterName::none) store_moments(renderer.capture());
    renderer.draw();
    const JudgeOutcome judged = renderer.judged();
    ASSERT_TRUE(judged.result) << reason(judged);
    EXPECT_EQ(notes_of_judged(judged), "");
    for (std::size_t k = static_cast<std::size_t>(Label::caster_bias); k <= compare::class_count; ++k)
      EXPECT_EQ(judged.result->lights[0].classes[k - 1], 0U) << label_name(static_cast<Label>(k));
  }
}

// A texel of one depth, or of two of which the receiver has one: the quadratic of their distribution has no solution.
TEST(JudgeMoments, OfOneOrTwoDepthsHaveAShareBefore) {
  const auto of = [](double share, double first, double second) {
    std::array<double, 4> out{};
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = share * std::pow(first, double(k + 1)) + (1.0 - share) * std::pow(second, double(k + 1));
    return out;
  };
  EXPECT_EQ(judge::least_share_before(of(1.0, 0.5, 0.0), 0.75), 1.0);
  EXPECT_EQ(judge::least_share_before(of(1.0, 0.5, 0.0), 0.25), 0.0);
  EXPECT_EQ(judge::least_share_before(of(1.0, 0.5, 0.0), 0.5), 0.0);
  EXPECT_NEAR(judge::least_share_before(of(0.25, 0.0, 1.0), 1.0), 0.25, 1e-12);
  EXPECT_NEAR(judge::least_share_before(of(0.25, 0.0, 1.0), 0.5), 0.25, 1e-12);
  EXPECT_EQ(judge::least_share_before(of(0.25, 0.0, 1.0), 0.0), 0.0);
}

std::vector<float> numbers_of(const std::function<double(double)>& stored) {
  std::vector<float> out;
  Dice dice(3);
  for (int k = 0; k < 400; ++k) out.push_back(static_cast<float>(stored(dice.between(0.2, 0.9))));
  return out;
}

TEST(JudgeFormats, AreToldByWhatNumbersHaveInCommon) {
  for (const double most : {255.0, 256.0, 1023.0, 4095.0, 65535.0, 65536.0, 255.0 * 255.0}) {
    const auto format = judge::find_format(numbers_of([=](double v) { return std::floor(most * v) / most; }));
    EXPECT_FALSE(format.floating) << most;
    EXPECT_EQ(format.step, 1.0 / most) << "also where the numbers are truncated";
  }
  const auto halves = judge::find_format(numbers_of([](double v) {
    const double step = std::ldexp(1.0, std::ilogb(v) - 10);
    return step * std::floor(v / step);
  }));
  EXPECT_TRUE(halves.floating);
  EXPECT_EQ(halves.step, 0x1p-11);
  EXPECT_EQ(judge::step_near(halves, 0.3), 0x1p-12);
  EXPECT_EQ(judge::format_notes(halves, 1.0),
            std::vector<std::string>{"the map's depths are half floats: eleven bits"});
  const auto floats = judge::find_format(numbers_of([](double v) { return v; }));
  EXPECT_EQ(floats.step, 0x1p-24);
  EXPECT_TRUE(judge::format_notes(floats, 1.0).empty());
  // Two floors at even depths tell nothing.
  const auto level = judge::find_format(numbers_of([](double v) { return v < 0.5 ? 0.25 : 0.5; }));
  EXPECT_EQ(level.step, 0x1p-24);
}

}  // namespace
}  // namespace gnomon::test
