// Overlapping glass against the closed form of plane layers, and glass that priorities hide.
#include "raytrace/frame.h"
#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

struct Layer {
  double ior, absorption, thickness;
};

/// Share reflected at a boundary, from the two angles alone (Fresnel's sine and tangent laws; Born & Wolf
/// 1999, section 1.5.2, eq. 21a): another formula than the tracer's.
long double reflected(long double in, long double out) {
  if (in < 1e-4L || std::abs(in - out) < 1e-12L) {  // the laws are 0/0: their limit
    const long double n = in < 1e-4L && out > 0.0L ? in / out : 1.0L;
    return (n - 1.0L) * (n - 1.0L) / ((n + 1.0L) * (n + 1.0L));
  }
  const long double s = std::sin(in - out) / std::sin(in + out), p = std::tan(in - out) / std::tan(in + out);
  return 0.5L * (s * s + p * p);
}

/// Share of the light that goes straight through all layers, without inner reflections.
template <std::size_t N>
double transmitted(const std::array<Layer, N>& layers, double angle) {
  long double share = 1.0L, before = angle;
  const long double sine = std::sin(static_cast<long double>(angle));
  for (const Layer& layer : layers) {
    const long double inside = std::asin(sine / layer.ior);
    share *= (1.0L - reflected(before, inside)) *
             std::exp(-static_cast<long double>(layer.absorption) * layer.thickness / std::cos(inside));
    before = inside;
  }
  return static_cast<double>(share * (1.0L - reflected(before, angle)));
}

Material glass_of(const Layer& layer, int priority) {
  Material m;
  m.diffuse = Vec3f(0.0f), m.transmission = 1.0f, m.priority = priority;
  m.ior = static_cast<float>(layer.ior), m.absorption = Vec3f(static_cast<float>(layer.absorption));
  return m;
}

/// What a camera sees of a glowing wall behind two slabs that overlap.
double traced(const Run& run, const Layer& front, const Layer& back, double overlap, bool front_wins,
              double angle) {
  Scene scene =
      scene_of({box({-40, -40, -front.thickness}, {40, 40, 0}),
                box({-40, -40, -front.thickness - back.thickness}, {40, 40, overlap - front.thickness}),
                quad({-90, -90, -9}, {180, 0, 0}, {0, 180, 0})});
  scene.materials = {glass_of(front, front_wins ? 1 : 0), glass_of(back, front_wins ? 0 : 1), Material{}};
  scene.materials[2].diffuse = Vec3f(0.0f), scene.materials[2].emission = Vec3f(1.0f);
  scene.instances[1].material = 1, scene.instances[2].material = 2;
  scene.camera.eye = 5.0 * Vec3(std::sin(angle), 0.0, std::cos(angle)), scene.camera.target = Vec3(0.0);
  scene.max_depth = 3;  // three boundaries; light reflected on its way needs more
  const SmallWorld w(std::move(scene));
  raytrace::RaytraceOptions options;
  options.size = {1, 1}, options.min_contribution = 0.0, options.records = false;
  const raytrace::Tracer tracer = run.tracer(w.world(), raytrace::Accel::brute);
  return static_cast<double>(
      trace_frame(tracer, plan_effects(w.scene()), w.scene().camera, {}, options).color.at(0, 0).x);
}

/// The textbook knows the medium entered last, and that air is behind every surface that is left.
double naive(const Layer& front, const Layer& back, double overlap, double angle) {
  const std::array<Layer, 2> before{
      {{front.ior, front.absorption, front.thickness - overlap}, {back.ior, back.absorption, overlap}}};
  const std::array<Layer, 1> behind{{{1.0, 0.0, back.thickness}}};
  return transmitted(before, angle) * transmitted(behind, angle);
}

}  // namespace

void nested_glass(Run& run) {
  // Radiance is in floats: some ten roundings of 6e-8, and the exponents' own.
  constexpr double bound = 1e-5;
  run.sample(
      "overlapping slabs", run.rays(1e-3),
      [&](Random& r, Tally& tally) {
        const auto layer = [&] {
          return Layer{static_cast<double>(static_cast<float>(r.uniform(1.05, 2.5))),
                       static_cast<double>(static_cast<float>(r.uniform(0.0, 1.0))), r.uniform(0.3, 2.0)};
        };
        const Layer front = layer(), back = layer();
        const double angle = r.uniform(0.02, 1.2), overlap = r.uniform(0.001, 0.29);
        const bool front_wins = r.coin();
        std::array<Layer, 2> layers{front, back};
        if (!front_wins) layers[0].thickness -= overlap, layers[1].thickness += overlap;
        const double expected = transmitted(layers, angle);
        const double seen = run.is_textbook() ? naive(front, back, overlap, angle)
                                              : traced(run, front, back, overlap, front_wins, angle);
        const double error = std::abs(seen - expected) / expected;
        tally.check(error <= bound);
        tally.error(error);
      },
      "share of the light", bound);
}

}  // namespace gnomon::verify
