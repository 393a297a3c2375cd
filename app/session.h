// What every command that works on a scene begins with: the scene loaded, flattened and planned, lights
// chosen by name, a renderer made, the number of threads set.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/outputs/run_files.h"
#include "raster/renderer.h"
#include "scene/base/expected.h"
#include "scene/effects.h"
#include "scene/keyed_path.h"
#include "scene/world.h"

namespace gnomon::app {

/// Where many pictures are made and none is looked at long: benchmarks, the suite's masks.
inline constexpr ImageSize quick_picture{640, 360};

/// The world points into the scene, so both stay where they are.
struct LoadedScene {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<World> world;
  EffectPlan plan;
  std::vector<KeyedPath>
      paths{};  ///< that the file itself has (LoadOptions::paths), where they were asked for
  std::vector<NamedCamera> cameras{};  ///< of the file, where they were asked for
  double load_ms = 0.0;
  std::size_t lights_left_out = 0;  ///< by keep_strongest_lights()
};

/// A file, a built-in scene or a lesson. Prints the loader's notes. `tessellate`: shapes become triangles
/// (scene/shapes/tessellate.h); 0: they stay exact. `camera`: LoadOptions::camera. `files` learns what the scene
/// consists of; ErrorKind::usage when an output is among it.
Expected<LoadedScene> load(const SceneArgument& argument, RunFiles& files, Console& console,
                           int tessellate = 0, const std::string& camera = {}, bool with_paths = false,
                           bool tessellation_is_asked = true, bool with_cameras = false);

/// Indices in Scene::lights: all of them, or the one with that name. ErrorKind::usage when there is none.
Expected<std::vector<std::uint32_t>> choose_lights(const Scene& scene, const std::string& name);

/// Says what draws where OSMesa does not, which is asked first. Error (graphics): the machine has none of that kind, or no memory
/// for it.
Expected<std::unique_ptr<raster::Context>> make_context(raster::Backend backend, Console& console);
/// Ready for every technique.
Expected<std::unique_ptr<raster::Renderer>> make_renderer(raster::Backend backend, const LoadedScene& loaded,
                                                          Console& console,
                                                          const std::string& shader_folder = {});
Expected<std::unique_ptr<raster::Renderer>> make_renderer(std::unique_ptr<raster::Context> context,
                                                          const LoadedScene& loaded,
                                                          const std::string& shader_folder = {});

/// Files of --shader-dir that did not draw the frame are noted; an error (bad input) where none did, with the
/// file that would have.
Expected<void> check_shaders_used(const std::string& shader_folder, const raster::RasterFrame& frame,
                                  const Scene& scene, Console& console);

/// Limits the ray tracer's threads (oneTBB) and, because it is read when a context is made, those of Mesa's software
/// rasterizer, for the rest of the process; once. 0: all cores. Where the system does not let so many be started (ulimit
/// -u) it takes fewer, and says so.
void limit_threads(int threads, Console& console);

/// out/NAME, NAME being that of the scene without folder and extension.
std::string default_output(const std::string& path_or_name);

}  // namespace gnomon::app
