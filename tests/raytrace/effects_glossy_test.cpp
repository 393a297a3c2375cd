// Rough mirrors and rough glass: the share of light that comes back against an integral of the GGX model by
// quadrature, which shares no sampling with the tracer; the limit of roughness 0; thin sheets.
#include <gtest/gtest.h>

#include <cstdio>

#include "raytrace/shading/microfacet.h"
#include "raytrace/shading/sampling.h"
#include "tests/support/effects_support.h"

namespace gnomon {
namespace {

using test::glass_of;
using test::mirror_of;
using test::trace_picture;

// A rough mirror seen at an angle from its normal, under a sky of radiance 1.
double furnace(double angle, float roughness, int samples) {
  Scene scene = test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0})});
  scene.materials[0] = mirror_of(1.0f, roughness);
  scene.background = Vec3f(1.0f);
  scene.glossy_samples = samples;
  scene.camera.eye = 3.0 * Vec3(std::sin(angle), std::cos(angle), 0.0);
  scene.camera.target = {0, 0, 0}, scene.camera.up = {0, 0, 1}, scene.camera.vertical_fov = 1e-6;
  return trace_picture(scene).color.at(0, 0).x;
}

// Smith's G1 and the GGX distribution (Walter et al. 2007, eqs. 33 and 34).
double hidden(double alpha, double cosine) {
  const double tan2 = 1.0 / (cosine * cosine) - 1.0;
  return 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * tan2));
}
double distribution(double alpha, double cosine) {
  const double d = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
  return alpha * alpha / (pi * d * d);
}

// Integral over facets m of D(m) G1(v) G1(l) (v.m) / v.z: the reflectance without Fresnel (eq. 20 with the
// Jacobian of eq. 14), by midpoints.
double reflectance(double angle, double alpha) {
  const Vec3 v(std::sin(angle), 0.0, std::cos(angle));
  constexpr int steps = 800;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      // Slopes grow as tan(theta) of a distribution of width alpha: u in (0, 1) spreads them evenly enough.
      const double u = (i + 0.5) / steps, phi = 2.0 * pi * (j + 0.5) / steps;
      const double tan2 = alpha * alpha * u / (1.0 - u), cosine = 1.0 / std::sqrt(1.0 + tan2);
      const double sine = std::sqrt(1.0 - cosine * cosine);
      const Vec3 m(sine * std::cos(phi), sine * std::sin(phi), cosine);
      const double facing = glm::dot(v, m);
      const Vec3 l = 2.0 * facing * m - v;
      if (!(facing > 0.0) || !(l.z > 0.0)) continue;
      // du dphi to solid angle: sin(theta) dtheta = cos^3 d(tan^2) / 2.
      const double solid = cosine * cosine * cosine * alpha * alpha / ((1.0 - u) * (1.0 - u)) / 2.0;
      sum += distribution(alpha, cosine) * hidden(alpha, v.z) * hidden(alpha, l.z) * facing / v.z * solid;
    }
  return sum * 2.0 * pi / (double(steps) * steps);
}

TEST(Glossy, FurnaceGivesWhatTheModelSays) {
  std::printf("%9s %7s %10s %10s\n", "roughness", "angle", "traced", "integral");
  for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f})
    for (const double angle : {0.1, 0.8, 1.3}) {
      const double traced = furnace(angle, roughness, 16384);
      const double integral = reflectance(angle, double(roughness) * double(roughness));
      std::printf("%9.2f %7.2f %10.5f %10.5f\n", roughness, angle, traced, integral);
      EXPECT_LE(traced, 1.0 + 1e-6);
      // 16384 stratified samples of weights between 0 and 1; the quadrature's own error is 1e-4.
      EXPECT_NEAR(traced, integral, 2e-3) << roughness << " " << angle;
    }
}

TEST(Glossy, SmoothLimitKeepsAllLight) {
  for (const double angle : {0.0, 0.5, 1.2, 1.5}) EXPECT_NEAR(furnace(angle, 1e-3f, 64), 1.0, 1e-6) << angle;
}

Scene rough_things(float roughness) {
  Scene scene =
      test::scene_of({}, {test::plane({0, 0, 0}, {0, 1, 0}), test::sphere({-0.625, 1.25, 1.25}, 1.0, 1),
                          test::sphere({1.25, 1.0, -0.75}, 1.0, 2)});
  scene.materials.push_back(glass_of(1.5f));
  scene.materials.push_back(mirror_of(0.8f));
  scene.materials[1].roughness = scene.materials[2].roughness = roughness;
  scene.lights = {test::point_light({-4, 6, 4})};
  scene.lights[0].intensity = Vec3f(40.0f);
  scene.background = {0.3f, 0.5f, 0.8f}, scene.ambient = Vec3f(0.1f);
  scene.camera.eye = {0.25, 2.25, 6}, scene.camera.target = {0, 0.875, 0};
  scene.glossy_samples = 8;
  return scene;
}

TEST(Glossy, RoughnessToZeroIsTheMirrorAndTheGlass) {
  const ImageSize size{80, 60};
  const auto sharp = trace_picture(rough_things(0.0f), size);
  EXPECT_EQ(sharp.rays.glossy, 0u);
  double before = infinity;
  for (const float roughness : {0.3f, 0.1f, 0.03f, 0.001f}) {
    const auto rough = trace_picture(rough_things(roughness), size);
    EXPECT_GT(rough.rays.glossy, 0u);
    double sum = 0.0;
    for (std::size_t i = 0; i < size.pixels(); ++i) {
      const Vec3f d = glm::abs(rough.color.data[i] - sharp.color.data[i]);
      sum += std::max({d.x, d.y, d.z});
    }
    const double mean = sum / static_cast<double>(size.pixels());
    EXPECT_LT(mean, before) << roughness;
    before = mean;
  }
  // alpha = 1e-6: facets lean by about that, and the picture changes only where an outline is crossed.
  EXPECT_LT(before, 1e-4);
}

TEST(Glossy, RoughGlassInAFurnaceNeverGains) {
  Scene scene = test::scene_of({}, {test::sphere({0, 0, 0}, 1.0)});
  scene.background = Vec3f(1.0f), scene.max_depth = 40, scene.glossy_samples = 4096;
  scene.camera = test::straight_down_z(4.0);
  scene.camera.target = {0.5, 0.0, 0.0};
  double before = 0.0;
  for (const float roughness : {0.8f, 0.4f, 0.1f, 0.001f}) {
    scene.materials[0] = glass_of(1.5f);
    scene.materials[0].roughness = roughness;
    const double traced = trace_picture(scene).color.at(0, 0).x;
    EXPECT_LE(traced, 1.0 + 1e-6) << roughness;
    EXPECT_GT(traced, before) << roughness;  // single scattering loses less where it is smoother
    before = traced;
  }
  EXPECT_NEAR(before, 1.0, 1e-5);
}

TEST(Glossy, AThinSheetBlursWhatIsBehindIt) {
  // A sheet over a floor that is half black, half white: seen from above the border, half of either.
  Scene scene = test::scene_of({test::quad({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}),
                                test::quad({-50, -50, 0}, {50, 0, 0}, {0, 100, 0}),
                                test::quad({0, -50, 0}, {50, 0, 0}, {0, 100, 0})});
  scene.materials.resize(3);
  scene.materials[0] = glass_of(1.5f);
  scene.materials[0].thin = true;
  scene.materials[1].diffuse = scene.materials[2].diffuse = Vec3f(0.0f);
  scene.materials[2].emission = Vec3f(1.0f);
  scene.instances[1].material = 1, scene.instances[2].material = 2;
  scene.camera = test::straight_down_z(4.0);
  scene.camera.eye.x = scene.camera.target.x = -0.01;
  EXPECT_EQ(trace_picture(scene).color.at(0, 0).x, 0.0f);  // straight on: the black half
  scene.materials[0].roughness = 0.5f, scene.glossy_samples = 16384;
  const double seen = trace_picture(scene).color.at(0, 0).x;
  EXPECT_GT(seen, 0.4);
  EXPECT_LT(seen, 0.5);
}

}  // namespace
}  // namespace gnomon
