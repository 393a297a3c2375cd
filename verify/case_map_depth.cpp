// Depths of the map: what each format keeps of a depth range of 1 to 5,000, and biases without bounds. The
// oracle knows where it put the plates; the quantum of a format is the closed form of its number.
#include "verify/cases.h"
#include "verify/drawn_world.h"

namespace gnomon::verify {

namespace {

constexpr int plate_count = 8;
constexpr double cone = 0.25;  // tangent of the half-angle that the plates fill

double plate_depth(int k) {
  return 0.2 * std::pow(5e3, double(k) / (plate_count - 1));
}

/// Plates across the light's axis, beside one another as the light sees them: plate k from tangent low(k) to
/// low(k + 1).
double low(int k) {
  return cone * (2.0 * k / plate_count - 1.0);
}

Scene plates(LightType type) {
  std::vector<Mesh> meshes;
  for (int k = 0; k < plate_count; ++k) {
    const double z = plate_depth(k), w = type == LightType::spot ? z : 1.0;
    meshes.push_back(
        quad({w * low(k), -z, -w * cone}, {0, 0, 2.0 * w * cone}, {w * (low(k + 1) - low(k)), 0, 0}));
  }
  Scene scene = scene_of(std::move(meshes));
  Light light = type == LightType::spot ? point_light({0, 0, 0}) : sun({0, -1, 0});
  light.type = type, light.direction = {0, -1, 0};
  light.outer_angle = std::atan(1.2 * cone), light.inner_angle = 0.5 * light.outer_angle;
  scene.lights = {light};
  scene.camera.eye = {0.0, 3000.0, 1.0}, scene.camera.target = {0.0, -500.0, 0.0};
  return scene;
}

struct Format {
  raster::DepthFormat format;
  const char* name;
  int bits;
  bool reversed;
  double bound;  // quanta: half for the rounding to the format, and what float arithmetic loses before it
};
constexpr std::array formats{Format{raster::DepthFormat::d16, "d16", 16, false, 1.0},
                             Format{raster::DepthFormat::d24, "d24", 24, false, 8.0},
                             Format{raster::DepthFormat::d32f, "d32f", 24, false, 8.0},
                             Format{raster::DepthFormat::d32f_reversed, "d32f-reversed", 24, true, 8.0}};

/// World units of depth for one step of the stored number at depth z.
double quantum(const Format& f, LightType type, double n, double far, double z) {
  const bool perspective = type == LightType::spot;
  const double step_per_depth = perspective ? n * far / (z * z * (far - n)) : 1.0 / (far - n);
  const double from_far = perspective ? n * (far - z) / (z * (far - n)) : (far - z) / (far - n);
  // A float keeps its bits below the leading one: near 1 as many as a 24-bit fraction, near 0 far more.
  const double step =
      std::exp2(-f.bits) * (f.reversed ? std::exp2(std::floor(std::log2(from_far)) + 1.0) : 1.0);
  return step / step_per_depth;
}

std::string plates_row(const Format& f, LightType type) {
  return std::string(f.name) + (type == LightType::spot ? ", perspective" : ", orthographic");
}

/// In plates from the first one's side on, where the light sees a texel's centre.
double plates_across(const LightView& view, LightType type, std::uint64_t texel) {
  const auto size = static_cast<std::uint64_t>(view.size);
  const Ray ray = texel_ray(view, 0, double(texel % size) + 0.5, double(texel / size) + 0.5);
  const double x = type == LightType::spot ? ray.direction.x / -ray.direction.y : ray.origin.x;
  return 0.5 * plate_count * (x / cone + 1.0);
}
/// Corners are rounded to 1/256 of a texel, and a plate is some 26 texels wide.
constexpr double beside_an_edge = 1e-3;

void check_plates(Run& run, const raster::ShadowMap& map, const Format& f, LightType type) {
  const double n = map.view.face(0).near_depth, far = map.view.face(0).far_depth;
  const Vec3 forward = map.view.face(0).forward;
  const auto size = static_cast<std::uint64_t>(map.view.size);
  run.sample_each(
      plates_row(f, type), size * size,
      [&](std::uint64_t i, Tally& tally) {
        const double stored = map.depth[i];
        if (stored == (f.reversed ? 0.0 : 1.0)) return;
        const double across = plates_across(map.view, type, i);
        if (std::abs(across - std::round(across)) < beside_an_edge) return;
        const int plate = static_cast<int>(std::floor(across));
        const double z = plate_depth(plate) + glm::dot(-map.view.origin, forward);
        const double s =
            f.reversed ? 1.0 - stored : stored;  // exact enough: the check is made where s is far from 0
        const double back =
            type == LightType::spot
                ? (f.reversed ? n * far / (n + stored * (far - n)) : n * far / (far - s * (far - n)))
                : (f.reversed ? far - stored * (far - n) : n + s * (far - n));
        tally.check(plate >= 0 && plate < plate_count);
        // The last plate's own place lies at the far end, where a reversed float has no step of its own to
        // measure by.
        tally.error(std::abs(back - z) / std::max(quantum(f, type, n, far, z), std::exp2(-23.0) * z));
      },
      "quanta", f.bound);
}

}  // namespace

void depth_range(Run& run) {
  for (const LightType type : {LightType::spot, LightType::directional}) {
    DrawnWorld drawn(plates(type));
    if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "formats against their quantum");
    for (const Format& f : formats) {
      raster::RasterOptions options = drawing({16, 16}, 256, 0.0);
      options.map.depth_format = f.format;
      const auto frame = drawn.draw(options);
      if (frame)
        check_plates(run, frame->lights[0].map, f, type);
      else
        run.fault(plates_row(f, type), frame.error().message());
    }
  }
}

namespace {

constexpr double slab_height = 2.0;

/// A level floor, and a plate over its middle.
Scene floor_and_plate(const Vec3& direction) {
  Scene scene = scene_of(
      {quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0}), quad({-1, slab_height, -1}, {0, 0, 2}, {2, 0, 0})});
  scene.lights = {sun(direction)};
  scene.camera.eye = {0.01, 30.0, 9.0}, scene.camera.target = {0.0, 0.0, 0.0},
  scene.camera.vertical_fov = 0.35;
  return scene;
}

struct Shares {
  std::uint64_t lit = 0, lit_drawn_dark = 0, dark = 0, dark_drawn_lit = 0;
};

/// Floor pixels whose light ray passes the plate well inside or well outside its outline.
Shares shares(DrawnWorld& drawn, const raster::RasterFrame& frame) {
  const Vec3 d = drawn.scene().lights[0].direction;
  Shares out;
  for (int y = 0; y < frame.options.size.height; ++y) {
    for (int x = 0; x < frame.options.size.width; ++x) {
      if (frame.primitive.at(x, y) > 1) continue;  // the floor's two triangles
      const Ray ray = eye_ray(drawn.scene().camera, frame.options.size, x, y);
      const Vec3 p = ray.at(to_level(ray, 0.0));
      if (std::max(std::abs(p.x), std::abs(p.z)) > 7.4)
        continue;  // a texel across the floor's edge may be empty
      const Vec3 over = p - d * (slab_height / -d.y);
      const double reach = std::max(std::abs(over.x), std::abs(over.z));
      if (std::abs(reach - 1.0) < 0.2) continue;  // within some texels of the outline
      const bool truly_lit = reach > 1.0, drawn_lit = frame.lights[0].visibility.at(x, y) > 0.5f;
      out.lit += truly_lit, out.lit_drawn_dark += truly_lit && !drawn_lit;
      out.dark += !truly_lit, out.dark_drawn_lit += !truly_lit && drawn_lit;
    }
  }
  return out;
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? double(part) / double(whole) : 1.0;
}

/// One row: a share that must be as the closed form has it.
void expect_share(Run& run, const char* name, std::uint64_t tried, double got, double expected,
                  double bound) {
  run.sample_each(
      name, tried,
      [&](std::uint64_t, Tally& tally) { tally.check(true), tally.error(std::abs(got - expected)); }, "share",
      bound);
}

}  // namespace

void extreme_bias(Run& run) {
  DrawnWorld drawn(floor_and_plate({0.35, -1.0, 0.2}));
  if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "biases and their limits");
  const ImageSize size{320, 200};
  const auto with_bias = [&](double bias) {
    const auto frame = drawn.draw(drawing(size, 64, bias));
    return frame ? shares(drawn, *frame) : Shares{};
  };
  const Shares none = with_bias(0.0), negative = with_bias(-1e6), huge = with_bias(1e30);
  // Half of a texel lies behind its centre on any tilted plane; one pixel of light shadowed by an edge texel
  // is no acne.
  expect_share(run, "bias 0: half of the lit pixels are acne", none.lit, share(none.lit_drawn_dark, none.lit),
               0.5, 0.02);
  expect_share(run, "bias 0: nothing leaks", none.dark, share(none.dark_drawn_lit, none.dark), 0.0, 0.0);
  expect_share(run, "bias -1e6: all is acne", negative.lit, share(negative.lit_drawn_dark, negative.lit), 1.0,
               0.0);
  expect_share(run, "bias 1e30: all shadow leaks", huge.dark, share(huge.dark_drawn_lit, huge.dark), 1.0,
               0.0);
  expect_share(run, "bias 1e30: no acne", huge.lit, share(huge.lit_drawn_dark, huge.lit), 0.0, 0.0);
  const std::array bad{std::nan(""), infinity, -infinity};
  run.sample_each("bias NaN, infinite: refused", bad.size(), [&](std::uint64_t i, Tally& tally) {
    const auto frame = drawn.draw(drawing(size, 64, bad[i]));
    tally.check(!frame && frame.error().kind == ErrorKind::usage);
  });
  run.sample_each("map size 0: refused", 1, [&](std::uint64_t, Tally& tally) {
    const auto frame = drawn.draw(drawing(size, 0, 0.0));
    tally.check(!frame && frame.error().kind == ErrorKind::usage);
  });
  // One texel over a floor that lies evenly around its centre: half of it is behind the depth stored there.
  Scene alone = scene_of({quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0})});
  alone.lights = {sun({0.35, -1.0, 0.2})};
  alone.camera.eye = {0.0, 500.0, 0.001}, alone.camera.target = {0.0, 0.0, 0.0},
  alone.camera.vertical_fov = 0.02;
  DrawnWorld one(std::move(alone));
  const auto frame = one.draw(drawing({256, 256}, 1, 0.0));
  std::uint64_t seen = 0, dark = 0;
  if (frame) {
    for (std::size_t i = 0; i < frame->primitive.data.size(); ++i) {
      if (frame->primitive.data[i] == no_id) continue;
      ++seen, dark += frame->lights[0].visibility.data[i] < 0.5f;
    }
  }
  expect_share(run, "map size 1: half of the floor is acne", seen, share(dark, seen), 0.5, 0.02);
}

}  // namespace gnomon::verify
