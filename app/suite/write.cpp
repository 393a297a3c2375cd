#include "app/suite/write.h"

#include <embedded/suite.h>
#include <fmt/core.h>

#include "app/process/interrupt.h"
#include "scene/base/stages.h"
#include "scene/files/gltf/gltf_writer.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"
#include "scene/light.h"

namespace gnomon::app {

SuiteMask suite_mask(const Scene& scene, ImageSize size) {
  const World world = make_world(scene);
  const raytrace::Tracer tracer(world, raytrace::Accel::bvh, raytrace::Precision::exact);
  raytrace::RaytraceOptions options;
  options.size = size;
  options.picture = false;
  const std::uint32_t light = 0;
  const auto frame =
      raytrace::trace_frame(tracer, plan_effects(scene), scene.camera, std::span(&light, 1), options);
  const auto& centre = frame.lights.front().centre.data;
  SuiteMask mask{std::vector<float>(size.pixels(), 0.0f), std::vector<float>(size.pixels(), 0.0f)};
  for (std::size_t i = 0; i < size.pixels(); ++i) {
    const raytrace::SurfacePoint& point = frame.receiver.data[i];
    const bool asked = point.primitive != no_id && centre[i] != raytrace::PointVisibility::uncertain &&
                       !light_cannot_reach(scene.lights.front(), point.position, point.normal);
    mask.asked[i] = asked ? 1.0f : 0.0f;
    mask.lit[i] = asked && centre[i] == raytrace::PointVisibility::lit ? 1.0f : 0.0f;
  }
  return mask;
}

Expected<void> write_suite(const std::string& folder, ImageSize size, Console& console) {
  const std::vector<SuiteScene> suite = suite_scenes();
  std::vector<SuiteMask> masks;
  for (const SuiteScene& entry : suite) {
    console.progress("ray tracing", static_cast<double>(masks.size()) / static_cast<double>(suite.size()));
    masks.push_back(suite_mask(entry.scene, size));
  }
  const TimedStage writing("write");
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (std::size_t i = 0; i < suite.size(); ++i) {
    const std::string path = staged->path() + "/" + suite[i].scene.name;
    const auto gltf = write_gltf(suite[i].scene, true);
    if (!gltf) return fail(gltf.error());
    if (const auto written = write_file(path + ".glb", gltf->bytes); !written) return written;
    const std::vector<Channel> channels{{"V", std::move(masks[i].lit)}, {"A", std::move(masks[i].asked)}};
    if (const auto written = write_exr(path + ".exr", size, channels); !written) return written;
  }
  constexpr const char* introduction = "README.md";
  const std::string path = fmt::format("{}/{}", staged->path(), introduction);
  if (const auto written = write_file(path, embedded::suite(introduction)); !written) return written;
  if (const auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish(introduction);
}

}  // namespace gnomon::app
