// Refraction against Fresnel's equations in 128 bits, and glass that must not be seen.
#include <fmt/core.h>

#include <cfloat>

#include "raytrace/frame.h"
#include "raytrace/precision/error_bounds.h"
#include "raytrace/shading/fresnel.h"
#include "verify/cases.h"
#include "verify/quad.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

/// Transmitted share, from the two directions alone (Born & Wolf 1999, section 1.5.3): another formula than
/// the tracer's, which knows the reflected share only.
double transmitted(const Vec3& in, const Vec3& normal, const Vec3& out, double eta) {
  const Quad cos_in = -dot(Quad3(in), Quad3(normal)), cos_out = -dot(Quad3(out), Quad3(normal));
  const Quad n_in = Quad(eta), n_out = 1;
  const Quad s = 2 * n_in * cos_in / (n_in * cos_in + n_out * cos_out);
  const Quad p = 2 * n_in * cos_in / (n_out * cos_in + n_in * cos_out);
  return static_cast<double>(n_out * cos_out / (n_in * cos_in) * (s * s + p * p) / 2);
}

/// The textbook's: floats, and no thought of what stands under the root.
raytrace::Refraction naive_refract(const Vec3& in, const Vec3& normal, double eta) {
  const Vec3f i(in), n(normal);
  const float e = static_cast<float>(eta), cos_in = -glm::dot(i, n);
  const float cos_out = std::sqrt(1.0f - e * e * (1.0f - cos_in * cos_in));
  const float s = (e * cos_in - cos_out) / (e * cos_in + cos_out),
              p = (cos_in - e * cos_out) / (cos_in + e * cos_out);
  return {0.5f * (s * s + p * p), Vec3(e * i + (e * cos_in - cos_out) * n)};
}

void boundary(const Run& run, double angle, double eta, Random& r, Tally& tally) {
  Vec3 tangent, bitangent;
  const Vec3 normal(0.0, 0.0, 1.0);
  orthonormal_basis(normal, tangent, bitangent);
  const double turn = r.uniform(0.0, 2.0 * pi);
  const Vec3 along = std::cos(turn) * tangent + std::sin(turn) * bitangent;
  const Vec3 in = std::sin(angle) * along - std::cos(angle) * normal;
  const raytrace::Refraction refraction =
      run.is_textbook() ? naive_refract(in, normal, eta) : raytrace::refract(in, normal, eta);
  const double r_share = refraction.reflectance;
  tally.check(r_share >= 0.0 && r_share <= 1.0 && raytrace::all_finite(refraction.direction));
  if (!(glm::dot(refraction.direction, refraction.direction) > 0.0)) return;
  tally.error(std::abs(r_share + transmitted(in, normal, refraction.direction, eta) - 1.0) / DBL_EPSILON);
}

}  // namespace

void critical_angle(Run& run) {
  constexpr const char* unit = "ulp of R + T";
  constexpr double ulps = 4.0;
  run.sample(
      "any angle", run.rays(0.1),
      [&](Random& r, Tally& tally) {
        const double ior = r.uniform(1.0, 3.0);
        const double angle = std::acos(r.uniform(0.0, 1.0));
        boundary(run, angle, r.coin() ? ior : 1.0 / ior, r, tally);
      },
      unit, ulps);
  run.sample(
      "critical +- 1e-12", run.rays(0.1),
      [&](Random& r, Tally& tally) {
        const double ior = r.uniform(1.05, 3.0);
        boundary(run, std::asin(1.0 / ior) + r.uniform(-1e-12, 1e-12), ior, r, tally);
      },
      unit, ulps);
  run.sample(
      "90 degrees - 1e-6 to 0", run.rays(0.1),
      [&](Random& r, Tally& tally) {
        const double ior = r.uniform(1.05, 3.0);
        const double angle = pi / 2 - r.power_of_ten(-17.0, -6.0);
        boundary(run, angle, r.coin() ? ior : 1.0 / ior, r, tally);
      },
      unit, ulps);
}

namespace {

/// A marble wholly inside another of a higher priority, whatever its index and colour, is not there.
void hidden_glass(Run& run) {
  Scene plain = scene_of({quad({-9, 0, -9}, {0, 0, 18}, {18, 0, 0})}, {sphere({0.0, 1.2, 0.0}, 1.0)});
  Material outer;
  outer.transmission = 1.0f, outer.ior = 1.5f, outer.priority = 1, outer.absorption = Vec3f(0.3f);
  Material inner = outer;
  inner.ior = 2.4f, inner.priority = 0, inner.absorption = Vec3f(5.0f);
  plain.materials.push_back(outer);
  plain.materials.push_back(inner);
  plain.shapes[0].material = 1;
  plain.background = Vec3f(0.2f, 0.3f, 0.4f);
  plain.lights = {point_light({3.0, 6.0, 2.0})};
  plain.camera.eye = {0.25, 2.25, 6.0}, plain.camera.target = {0.0, 1.0, 0.0};
  Scene hidden = plain;
  hidden.shapes.push_back(sphere({0.2, 1.3, 0.1}, 0.5));
  hidden.shapes[1].material = 2;
  const SmallWorld w(plain), h(hidden);
  const raytrace::Tracer without = run.tracer(w.world()), with = run.tracer(h.world());
  raytrace::RaytraceOptions options;
  const int side = static_cast<int>(std::sqrt(static_cast<double>(run.rays(0.01, 100'000))));
  options.size = {side, side};
  const auto a = trace_frame(without, plan_effects(plain), plain.camera, {}, options);
  const auto b = trace_frame(with, plan_effects(hidden), hidden.camera, {}, options);
  run.sample_each("hidden by priority", a.color.data.size(), [&](std::uint64_t i, Tally& tally) {
    const Vec3f d = glm::abs(a.color.data[i] - b.color.data[i]);
    tally.check(std::max({d.x, d.y, d.z}) <= 1e-5f);
  });
}

}  // namespace

void invisible_glass(Run& run) {
  Scene plain = scene_of({quad({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}), box({-2, 0, -2}, {-1, 2, -1})});
  plain.background = Vec3f(0.2f, 0.3f, 0.4f), plain.max_depth = 16;
  plain.lights = {point_light({3.0, 6.0, 2.0})};
  plain.camera.eye = {0.0, 2.0, 6.0}, plain.camera.target = {0.0, 1.0, 0.0};
  Scene glass = plain;
  Material clear;
  clear.transmission = 1.0f, clear.ior = 1.0f;
  glass.materials.push_back(clear);
  glass.shapes = {sphere({0.5, 1.2, 0.0}, 1.0), sphere({0.0, 2.0, 6.0}, 0.5)};  // the second about the eye
  for (Shape& shape : glass.shapes) shape.material = 1;
  const SmallWorld w(plain), g(glass);
  const raytrace::Tracer tracer = run.tracer(w.world()), through = run.tracer(g.world());
  raytrace::RaytraceOptions options;
  const int side = static_cast<int>(std::sqrt(static_cast<double>(run.rays(0.05, 250'000))));
  options.size = {side, side};
  const auto seen_plain = trace_frame(tracer, plan_effects(plain), plain.camera, {}, options);
  const auto seen_glass = trace_frame(through, plan_effects(glass), glass.camera, {}, options);
  // Outlines may fall on the other side of a pixel's ray that was refracted by rounding.
  const std::uint64_t pixels = seen_plain.color.data.size();
  run.sample_each("pixels alike", pixels, [&](std::uint64_t i, Tally& tally) {
    const Vec3f d = glm::abs(seen_plain.color.data[i] - seen_glass.color.data[i]);
    tally.check(std::max({d.x, d.y, d.z}) <= 1e-5f);
  });
  hidden_glass(run);
  nested_glass(run);
}

}  // namespace gnomon::verify
