// What must not change when the same scene is given in other numbers, lengths times a power of two; and a
// light in the plane of faces, which rounding used to turn.
#include <array>

#include "raster/technique_traits.h"
#include "verify/cases.h"
#include "verify/drawn_world.h"
#include "verify/random_scene.h"

namespace gnomon::verify {

namespace {

using raster::Technique;

void scale(Scene& scene, double factor) {
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p *= factor;
  for (Light& light : scene.lights) light.position *= factor;
  scene.camera.eye *= factor, scene.camera.target *= factor;
}

raster::RasterOptions options_of(Technique technique) {
  raster::RasterOptions options = drawing({160, 90}, 256, 0.5);
  options.map.bias.unit = raster::BiasUnit::texel;
  options.map.technique = technique;
  return options;
}

void compare_drawings(Run& run, const std::string& row, const raster::RasterFrame& a,
                      const raster::RasterFrame& b) {
  run.sample_each(row, a.primitive.data.size(), [&](std::uint64_t i, Tally& tally) {
    tally.check(a.lights[0].visibility.data[i] == b.lights[0].visibility.data[i]);
  });
}

}  // namespace

void scale_invariance(Run& run) {
  for (const auto& [type_name, type] :
       {std::pair{"point", LightType::point}, {"spot", LightType::spot}, {"sun", LightType::directional}}) {
    const Scene given = invariant_scene(type, Random(run.seed()));
    Scene large = given, small = given;
    scale(large, 0x1p24), scale(small, 0x1p-20);
    DrawnWorld here(given), there(std::move(large)), tiny(std::move(small));
    if (!here.ready()) return add_row_of_undrawn(run, here, "lengths times 2^24 and 2^-20");
    for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
      const Technique technique = traits.technique;
      // Nothing of the hybrid is drawn: it asks the tracer.
      if (!traits.lights.has(type) || raster::is_external(technique)) continue;
      const auto options = options_of(technique);
      const auto a = here.draw(options), b = there.draw(options), c = tiny.draw(options);
      const std::string row = std::string(type_name) + ", " + std::string(traits.name);
      if (!a || !b || !c) {
        run.fault(row, (!a ? a : !b ? b : c).error().message());
        continue;
      }
      compare_drawings(run, row + " times 2^24", *a, *b);
      compare_drawings(run, row + " times 2^-20", *a, *c);
    }
  }
}

// izb promises the shadows of which the robust tracer is certain, and no others: so that precision is asked
// here whatever the table is made for.
void coplanar_lights(Run& run) {
  raytrace::RaytraceOptions rays;
  rays.picture = false;
  rays.size = {160, 90};
  auto options = drawing(rays.size, 64, 0.0);
  options.map.technique = Technique::izb;
  Random random(run.seed());
  const std::uint64_t scenes = run.rays(1e-4, 64);
  std::vector<Agreement> found;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    DrawnWorld drawn(random_scene(random));
    if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "izb against certain shadows");
    const std::array<std::uint32_t, 1> first{0};
    const raytrace::Tracer tracer(drawn.world(), raytrace::Accel::bvh);
    const auto traced = trace_frame(tracer, plan_effects(drawn.scene()), drawn.scene().camera, first, rays);
    const auto frame = drawn.draw(options);
    found.push_back(frame ? compare_with_rays(drawn.scene(), *frame, traced) : Agreement{1, 1});
  }
  run.sample_each(
      "izb against certain shadows, pixels of " + std::to_string(scenes) + " scenes", found.size(),
      [&](std::uint64_t i, Tally& tally) { tally.tried += found[i].asked, tally.wrong += found[i].wrong; });
}

}  // namespace gnomon::verify
