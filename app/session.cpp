#include "app/session.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "app/lesson_scene.h"
#include "app/suggest.h"
#include "hybrid/visibility.h"
#include "scene/load.h"
#include "scene/tessellate.h"
#include "scene/timing.h"

namespace gnomon::app {

Expected<LoadedScene> load(const std::string& path_or_name, Console& console, int tessellate) {
  const Stopwatch watch;
  console.progress("loading", 0.0);
  Expected<Scene> scene = load_scene(scene_of_lesson(path_or_name));
  if (!scene) return fail(scene.error());
  if (tessellate > 0) scene = tessellate_shapes(std::move(*scene), tessellate);
  LoadedScene loaded;
  loaded.scene = std::make_unique<Scene>(std::move(*scene));
  loaded.world = std::make_unique<World>(make_world(*loaded.scene));
  loaded.plan = plan_effects(*loaded.scene);
  loaded.load_ms = watch.elapsed_ms();
  if (const std::string note = lesson_note(path_or_name); !note.empty()) console.note(note);
  for (const std::string& note : loaded.scene->notes) console.note(note);
  return loaded;
}

Expected<std::vector<std::uint32_t>> choose_lights(const Scene& scene, const std::string& name) {
  std::vector<std::uint32_t> lights;
  std::vector<std::string_view> names;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    names.push_back(scene.lights[i].name);
    if (name.empty() || scene.lights[i].name == name) lights.push_back(i);
  }
  if (!lights.empty()) return lights;
  return fail(ErrorKind::usage, fmt::format("--light: the scene has no such light (got {}, allowed {}){}",
                                            name, fmt::join(names, ", "), did_you_mean(name, names)));
}

Expected<std::unique_ptr<raster::Renderer>> make_renderer(raster::Backend backend, const LoadedScene& loaded,
                                                          const std::string& shader_folder) {
  Expected<std::unique_ptr<raster::Context>> context = raster::create_context(backend);
  if (!context) return fail(context.error());
  return make_renderer(std::move(*context), loaded, shader_folder);
}

Expected<std::unique_ptr<raster::Renderer>> make_renderer(std::unique_ptr<raster::Context> context,
                                                          const LoadedScene& loaded,
                                                          const std::string& shader_folder) {
  auto renderer = raster::Renderer::create(std::move(context), *loaded.world, loaded.plan, shader_folder);
  if (renderer) (*renderer)->use_external_visibility(hybrid::make_visibility(*loaded.world));
  return renderer;
}

struct ThreadLimit::Impl {
  std::optional<tbb::global_control> control;
};

ThreadLimit::ThreadLimit(int threads) : impl_(std::make_unique<Impl>()) {
  if (threads == 0) return;
  impl_->control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  // Mesa's llvmpipe: 0 draws on the calling thread, N > 0 on N others while the caller waits.
  setenv("LP_NUM_THREADS", threads == 1 ? "0" : std::to_string(threads).c_str(), 1);
}

ThreadLimit::~ThreadLimit() = default;

std::string default_output(const std::string& path_or_name) {
  const std::string name = std::filesystem::path(path_or_name).stem().string();
  return "out/" + (name.empty() ? "scene" : name);
}

}  // namespace gnomon::app
