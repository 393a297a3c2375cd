// Lights that shrink from a radius of 1 to nothing. What is seen of them must approach the hard light's
// visibility, closer with every step, and be it in the end.
#include <fmt/core.h>

#include "raytrace/shading/light_samples.h"
#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

constexpr int light_samples = 16;
constexpr std::array<double, 10> sizes{1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-6, 1e-9, 1e-12, 0.0};

struct Kind {
  const char* name;
  LightExtent (*extent)(double size);
};
constexpr std::array<Kind, 4> kinds{{
    {"sphere", [](double size) -> LightExtent { return SphereLight{size}; }},
    {"disc",
     [](double size) -> LightExtent {
       return DiscLight{size, glm::normalize(Vec3(0.3, -1.0, 0.2))};
     }},
    {"rectangle",
     [](double size) -> LightExtent {
       return RectangleLight{{size, 0, 0}, {0, 0, 0.5 * size}};
     }},
    {"sun", [](double size) -> LightExtent { return SunDisc{size}; }},
}};

/// The textbook's share: light leaves an area A with radiance 1 / A, samples have the density 1 / A; in
/// floats.
double naive_share(double seen, double size) {
  const float area = std::numbers::pi_v<float> * static_cast<float>(size) * static_cast<float>(size);
  const float density = 1.0f / area, radiance = 1.0f / area;
  return static_cast<double>(static_cast<float>(seen) * radiance / density);
}

}  // namespace

void shrinking_lights(Run& run) {
  const SmallWorld w({box({-1, 1, -1}, {1, 1.2, 1})}, {plane(Vec3(0.0), Vec3(0.0, 1.0, 0.0))});
  const raytrace::Tracer tracer = run.tracer(w.world());
  Random random(run.seed());
  std::vector<raytrace::SurfacePoint> points(run.rays(5e-4, 20'000));
  for (auto& point : points) {
    const Vec3 foot{random.uniform(-4.0, 4.0), 0.0, random.uniform(-4.0, 4.0)};
    point = seen(tracer, foot + Vec3(0.0, 0.5, 0.0), foot);
  }
  for (const Kind& kind : kinds) {
    const bool is_sun = std::holds_alternative<SunDisc>(kind.extent(1.0));
    Light light = is_sun ? sun({0.2, -1.0, 0.1}) : point_light({0.3, 4.0, 0.2});
    std::array<double, sizes.size()> difference{};
    bool shares_valid = true;
    for (std::size_t s = 0; s < sizes.size(); ++s)
      for (std::size_t i = 0; i < points.size(); ++i) {
        light.extent = kind.extent(sizes[s]);
        const raytrace::PointVisibility hard = tracer.centre_visibility(points[i], light);
        double share = light_visibility(tracer, points[i], light, light_samples, i).share;
        if (run.is_textbook()) share = naive_share(share, sizes[s]);
        shares_valid = shares_valid && share >= 0.0 && share <= 1.0;
        if (hard != raytrace::PointVisibility::uncertain)
          difference[s] += std::abs(share - (hard == raytrace::PointVisibility::lit ? 1.0 : 0.0));
      }
    run.sample_each(kind.name, sizes.size(), [&](std::uint64_t s, Tally& tally) {
      // NaN fails every comparison.
      const bool falls = s == 0 ? difference[s] > 0.0 : difference[s] <= difference[s - 1];
      tally.check(falls && shares_valid && (sizes[s] > 1e-12 || difference[s] == 0.0));
    });
  }
}

}  // namespace gnomon::verify
