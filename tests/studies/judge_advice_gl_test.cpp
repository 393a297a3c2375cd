// What judge advises is drawn again by another renderer, on random captures: what is promised is what is then drawn, and
// nothing is worse. GNOMON_ADVICE=N in the environment takes N captures in place of 30, and prints the table;
// GNOMON_ADVICE_TEST=NAME takes those of one row, GNOMON_ADVICE_FIRST=SEED begins there.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>

#include "compare/result/judged.h"
#include "scene/light.h"
#include "tests/support/capture_support.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using compare::Advice;
using compare::AdvisedSetting;
using judge::Capture;
using judge::FilterName;

/// A figure that is said as it is holds within a tenth of a percent, one that is said to be "about" so within a fifth.
constexpr double exactly = 1e-3, about = 0.2;

enum class Kind {
  hard,
  pcf3,
  pcf5,
  linear,
  poisson,
  turned,
  cascades,
  vsm,
  esm,
  evsm,
  msm,
  cube,
  spot,
  count
};
constexpr const char* kind_names[] = {
    "hard", "pcf 3x3", "pcf 5x5", "pcf, linear", "Poisson", "Poisson, turned", "cascades", "vsm",
    "esm",  "evsm",    "msm",     "cube",        "spot"};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * double(engine_() % 1000003u) / 1000003.0;
  }
  std::size_t below(std::size_t count) { return engine_() % count; }
  template <class Value>
  Value one_of(std::initializer_list<Value> values) {
    return *(values.begin() + static_cast<std::ptrdiff_t>(below(values.size())));
  }

 private:
  std::mt19937 engine_;
};

Scene random_scene(Random& random, Kind kind) {
  std::vector<Mesh> meshes{floor_mesh(4, 4)};
  const std::size_t boxes = 2 + random.below(4);
  for (std::size_t i = 0; i < boxes; ++i) {
    const double x = random.between(-2.0, 2.0), z = random.between(-2.0, 2.0),
                 y = random.one_of({0.0, 0.0, 0.4});
    const double width = random.between(0.1, 0.9), height = random.between(0.2, 1.2),
                 depth = random.between(0.1, 0.9);
    meshes.push_back(box_mesh({x, y, z}, {x + width, y + height, z + depth}));
  }
  const double to_x = random.between(-1.0, 1.0), to_z = random.between(-1.0, 1.0);
  Scene scene = sunlit_scene(std::move(meshes), {to_x, random.between(-1.6, -0.5), to_z});
  scene.camera = {{3.5, 2.2, 4.5}, {0.2, 0.2, 0.0}, {0, 1, 0}, 0.8};
  if (kind != Kind::cube && kind != Kind::spot) return scene;
  Light& lamp = scene.lights[0];
  lamp.type = kind == Kind::cube ? LightType::point : LightType::spot;
  lamp.position = {random.between(-2.0, 2.0), random.between(2.5, 5.0), random.between(-2.0, 2.0)};
  lamp.direction = glm::normalize(-lamp.position);
  lamp.inner_angle = 0.7, lamp.outer_angle = 0.8;
  return scene;
}

/// What the description does not know of: a part of the picture that something else darkens, or where nothing is dark.
struct Elsewhere {
  int left = 0, top = 0, width = 0, height = 0;
  float value = 0.0f;

  void draw_on(const Capture& capture) const {
    spoil(capture.visibility, [&](ChannelImage& image) {
      for (int y = top; y < std::min(top + height, image.size.height); ++y)
        for (int x = left; x < std::min(left + width, image.size.width); ++x)
          image.channels[0]
              .values[static_cast<std::size_t>(y) * std::size_t(image.size.width) + std::size_t(x)] = value;
    });
  }
};

/// A random renderer with its random settings.
struct Engine {
  Kind kind;
  Compared drawn;
  Capture capture;
  FilterTaps filter{};
  Elsewhere elsewhere{};

  /// Draws the capture's picture with the settings of this one. A map of moments is made from its depths with them.
  void draw(Capture settings) const {
    if (settings.filter && settings.filter->read == judge::FilterRead::moments) {
      for (const judge::CapturedLayer& layer : settings.map)
        std::filesystem::copy_file(layer.depth + ".depths.exr", layer.depth,
                                   std::filesystem::copy_options::overwrite_existing);
      store_moments(settings);
    }
    draw_again(settings, drawn, 1.0f, false, filter);
    elsewhere.draw_on(settings);
  }
};

FilterTaps strewn_taps(Random& random, double radius, bool turned) {
  FilterTaps out{.turned = turned};
  while (out.taps.size() < 16) {
    const double x = random.between(-1.0, 1.0), y = random.between(-1.0, 1.0);
    if (x * x + y * y <= 1.0) out.taps.push_back(radius * Vec2(x, y));
  }
  return out;
}

void choose_filter(Random& random, Engine& engine) {
  judge::CapturedFilter& filter = engine.capture.filter.emplace();
  const auto pcf = [&](double radius, FilterTaps taps) {
    filter.kind = FilterName::pcf, filter.radius_texels = radius, engine.filter = std::move(taps);
  };
  const auto moments = [&](FilterName kind) {
    filter.kind = kind;
    filter.light_bleeding_reduction = random.one_of({0.0, 0.0, 0.2});
    filter.minimum_variance = random.one_of({0.0, 1e-6, 1e-4});
    filter.read = judge::FilterRead::moments, filter.radius_texels = 2.5;
    for (const judge::CapturedLayer& layer : engine.capture.map)
      std::filesystem::copy_file(layer.depth, layer.depth + ".depths.exr");
  };
  const auto side = static_cast<int>(1 + random.below(4));
  const double radius = random.between(1.5, 3.5);
  switch (engine.kind) {
    case Kind::pcf3:
      return pcf(1.5, square_taps(3));
    case Kind::pcf5:
      return pcf(2.5, square_taps(5));
    case Kind::linear:
      return pcf(0.5 * side + 0.5, square_taps(side, true));
    case Kind::poisson:
    case Kind::turned:
      return pcf(radius, strewn_taps(random, radius, engine.kind == Kind::turned));
    case Kind::cascades:
      return random.below(2) == 0 ? void() : pcf(1.5, square_taps(3));
    case Kind::vsm:
      return moments(FilterName::vsm);
    case Kind::esm:
      filter.exponents = {random.between(20.0, 60.0)};
      return moments(FilterName::esm);
    case Kind::evsm:
      filter.exponents = {random.between(5.0, 30.0)};
      if (random.below(2) == 0) filter.exponents.push_back(random.between(3.0, 10.0));
      return moments(FilterName::evsm);
    case Kind::msm:
      filter.moment_bias = random.one_of({3e-5, 1e-4});
      return moments(FilterName::msm);
    default:
      return;
  }
}

Engine random_engine(unsigned seed) {
  Random random(seed);
  const auto kind = static_cast<Kind>(seed % static_cast<unsigned>(Kind::count));
  raster::MapOptions map =
      hard_map(random.one_of({128, 256, 512}),
               kind == Kind::cascades ? raster::Technique::csm : raster::Technique::hard);
  map.bias = {.constant = 0.0, .unit = raster::BiasUnit::world};
  Engine engine{kind, draw_scene(random_scene(random, kind), {160, 96}, map), {}};
  engine.capture = self_capture(engine.drawn, folder_for("advice-" + std::to_string(seed)), {.map = true});
  const raster::LightRecord& record = engine.drawn.result.raster.lights[0];
  const LightFace& face = record.map.view.face(0);
  const bool lengths = kind == Kind::cube || kind == Kind::spot;
  const double unit = lengths ? 1.0 : face.far_depth - face.near_depth;
  judge::CapturedBias bias;
  bias.constant_depth = record.texel_world * random.one_of({0.0, 0.0, 0.1, 0.5, 1.5, 6.0}) / unit;
  bias.normal_offset_world = record.texel_world * random.one_of({0.0, 0.0, 0.0, 0.7, 4.0});
  engine.capture.bias = bias;
  choose_filter(random, engine);
  if (random.below(5) < 2)
    engine.elsewhere = {static_cast<int>(random.below(120)), static_cast<int>(40 + random.below(40)),
                        static_cast<int>(8 + random.below(20)), static_cast<int>(4 + random.below(10)),
                        random.one_of({0.0f, 0.0f, 1.0f})};
  engine.draw(engine.capture);
  return engine;
}

/// Sets what an advice names, by the capture's own keys.
void take(const AdvisedSetting& one, Capture& capture) {
  const std::string& key = one.setting;
  if (key == "bias.constant_depth")
    capture.bias->constant_depth = one.instead;
  else if (key == "bias.normal_offset_world")
    capture.bias->normal_offset_world = one.instead;
  else if (key == "filter.light_bleeding_reduction")
    capture.filter->light_bleeding_reduction = one.instead;
  else if (key == "filter.minimum_variance")
    capture.filter->minimum_variance = one.instead;
  else if (key == "filter.moment_bias")
    capture.filter->moment_bias = one.instead;
  else if (key == "filter.exponents[0]" || key == "filter.exponents[1]") {
    capture.filter->exponents.resize(key.ends_with("[1]") ? 2 : capture.filter->exponents.size());
    capture.filter->exponents[key.ends_with("[1]") ? 1 : 0] = one.instead;
  } else if (key.starts_with("map[") && key.ends_with("].bias.constant_depth")) {
    const auto layer = static_cast<std::size_t>(std::stoul(key.substr(4)));
    judge::CapturedBias bias = *capture.bias;
    bias.constant_depth = one.instead;
    capture.map[layer].bias = bias;
  } else {
    ADD_FAILURE() << "a setting that no capture has: " << key;
  }
}

/// Over the pixels that were compared.
struct Left {
  double wrong = 0.0, mean = 0.0;
};

Left left_by(const Capture& capture, const compare::LightComparison& light) {
  const auto picture = read_channels(capture.visibility);
  Left out;
  double count = 0.0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i])) continue;
    const double off = std::abs(double{picture->channels[0].values[i]} - double{light.rungs[0].data[i]});
    ++count, out.mean += off, out.wrong += off > 0.5 ? 1.0 : off == 0.5 ? 0.5 : 0.0;
  }
  return {out.wrong / count, out.mean / count};
}

struct Row {
  int captures = 0, advised = 0, exact = 0, approximate = 0, broken = 0, worse = 0;
  double off = 0.0, off_share = 0.0;  ///< the most: of exact promises, and of approximate ones
  double before = 0.0, after = 0.0;   ///< sums of mean errors
  std::size_t of_bleeding = 0;        ///< that are of moments' light bleeding reduction
};

void check_promise(double promised, double drawn, const Advice& advice, Row& row, const std::string& what) {
  const double off = std::abs(promised - drawn);
  const double allowed = advice.about ? std::max(exactly, about * std::max(promised, drawn)) : exactly;
  if (!advice.about)
    row.off = std::max(row.off, off);
  else if (off > exactly)
    row.off_share = std::max(row.off_share, off / std::max(promised, drawn));
  row.broken += off > allowed ? 1 : 0;
  EXPECT_LE(off, allowed) << what << ": promised " << promised << ", drawn " << drawn;
}

void check_capture(unsigned seed, std::map<Kind, Row>& table) {
  const Engine engine = random_engine(seed);
  Row& row = table[engine.kind];
  const JudgeOutcome judged = judge(engine.capture, *engine.drawn.scene);
  ASSERT_TRUE(judged.result) << seed << ": " << reason(judged);
  ++row.captures;
  const compare::LightComparison& light = judged.result->lights[0];
  const Left now = left_by(engine.capture, light);
  for (const Advice& advice : judged.result->judged->advice) {
    Capture again = engine.capture;
    take(advice, again);
    if (advice.with) take(*advice.with, again);
    for (const AdvisedSetting& layer : advice.layers) take(layer, again);
    engine.draw(again);
    const Left left = left_by(again, light);
    const std::string what = fmt::format("{} {}: {}", seed, kind_names[static_cast<std::size_t>(engine.kind)],
                                         compare::advice_text(advice));
    row.of_bleeding += advice.setting == "filter.light_bleeding_reduction" ? 1 : 0;
    ++row.advised, ++(advice.about ? row.approximate : row.exact);
    check_promise(advice.wrong_instead, left.wrong, advice, row, what + ", wrong");
    check_promise(*advice.mean_instead, left.mean, advice, row, what + ", mean");
    const bool worse = left.wrong > now.wrong || left.mean > now.mean;
    row.worse += worse ? 1 : 0;
    EXPECT_FALSE(worse) << what << "; drawn " << left.wrong << " wrong of " << now.wrong << ", mean "
                        << left.mean << " of " << now.mean;
    row.before += now.mean, row.after += left.mean;
  }
}

TEST(JudgeAdvice, IsWhatIsDrawnWithIt) {
  const char* asked = std::getenv("GNOMON_ADVICE");
  const char* begin = std::getenv("GNOMON_ADVICE_FIRST");
  const unsigned first = begin != nullptr ? static_cast<unsigned>(std::atoi(begin)) : 1;
  const unsigned count = asked != nullptr ? static_cast<unsigned>(std::atoi(asked)) : 30;
  std::map<Kind, Row> table;
  const char* only = std::getenv("GNOMON_ADVICE_TEST");
  for (unsigned seed = first; seed < first + count; ++seed)
    if (only == nullptr || kind_names[seed % static_cast<unsigned>(Kind::count)] == std::string(only))
      check_capture(seed, table);
  Row all;
  fmt::print("{:16} {:>8} {:>7} {:>5} {:>5} {:>9} {:>9} {:>6} {:>5} {:>8} {:>8}\n", "test", "captures",
             "advised", "exact", "about", "most off", "by share", "broken", "worse", "before", "after");
  const auto print = [](const char* name, const Row& r) {
    fmt::print("{:16} {:8} {:7} {:5} {:5} {:8.3f}% {:8.1f}% {:6} {:5} {:7.2f}% {:7.2f}%\n", name, r.captures,
               r.advised, r.exact, r.approximate, 100.0 * r.off, 100.0 * r.off_share, r.broken, r.worse,
               100.0 * r.before / std::max(1, r.advised), 100.0 * r.after / std::max(1, r.advised));
  };
  for (const auto& [kind, row] : table) {
    print(kind_names[static_cast<std::size_t>(kind)], row);
    all.captures += row.captures, all.advised += row.advised, all.exact += row.exact;
    all.approximate += row.approximate, all.broken += row.broken, all.worse += row.worse;
    all.off = std::max(all.off, row.off), all.off_share = std::max(all.off_share, row.off_share);
    all.before += row.before, all.after += row.after, all.of_bleeding += row.of_bleeding;
  }
  print("all", all);
  EXPECT_TRUE(only != nullptr || all.of_bleeding > 0) << "moments have a setting of their own";
  EXPECT_GT(3 * all.advised, all.captures) << "where there is much to gain, something is advised";
}

}  // namespace
}  // namespace gnomon::test
