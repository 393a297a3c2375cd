#include "app/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <thread>

#include "app/lesson_scene.h"
#include "app/process/machine.h"
#include "hybrid/visibility.h"
#include "raster/programs/shader_folder.h"
#include "raster/technique_traits.h"
#include "rays/visibility.h"
#include "raytrace/choose_tracer.h"
#include "scene/base/option_text.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "scene/base/threads.h"
#include "scene/base/timing.h"
#include "scene/files/pictures/texture_memory.h"
#include "scene/files/validate.h"
#include "scene/load.h"
#include "scene/shapes/tessellate.h"

namespace gnomon::app {
namespace {

/// Counts the primitives of the world that the scene makes.
std::uint64_t primitives_of(const Scene& scene) {
  std::uint64_t count = scene.shapes.size();
  for (const MeshInstance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
  return count;
}

Expected<const KeyedPath*> find_path(const std::vector<KeyedPath>& paths, const SceneTime& time) {
  std::vector<std::string_view> names;
  for (const KeyedPath& path : paths) names.push_back(path.name);
  if (names.empty())
    return fail(ErrorKind::usage,
                fmt::format("--time: the scene moves nothing by itself (got {:g})", time.seconds));
  for (const KeyedPath& path : paths)
    if (time.path.empty() || path.name == time.path) return &path;
  return fail(ErrorKind::usage,
              fmt::format("--time: the scene has no such animation or path (got {}, allowed {}){}", time.path,
                          fmt::join(names, ", "), did_you_mean(time.path, names)));
}

/// The scene as it stands then: objects are loaded there, camera and lights moved.
Expected<Scene> scene_at(const SceneTime& time, Scene scene, const std::string& name, LoadOptions options) {
  const auto path = find_path(*options.paths, time);
  if (!path) return fail(path.error());
  const KeyedPath keys = **path;
  if (keys.objects_until) {
    options.animation = keys.name, options.seconds = time.seconds;
    options.files = nullptr, options.paths = nullptr, options.cameras = nullptr;
    TextureMemory textures = options.textures->anew();
    options.textures = &textures;
    scene.textures.clear();  // those of the second reading take their place
    auto played = load_scene(name, options);
    if (!played) return played;
    scene = std::move(*played);
  }
  scene.camera = keys.camera_at(scene.camera, time.seconds);
  for (Light& light : scene.lights) light = keys.light_at(light, time.seconds);
  if (auto defect = find_setting_defect(scene)) {
    defect->file = scene.path;
    return fail(std::move(*defect));
  }
  return scene;
}

}  // namespace

Expected<LoadedScene> load(const SceneArgument& argument, RunFiles& files, Console& console, int tessellate,
                           const std::string& camera, bool with_paths, bool tessellation_is_asked,
                           bool with_cameras) {
  const TimedStage stage("load");
  if (startable_threads(1) == 0)
    return fail(ErrorKind::graphics, "not one thread can be started (a limit on processes, ulimit -u)");
  const Stopwatch watch;
  console.progress("loading", 0.0);
  std::vector<std::string> read;
  LoadedScene loaded;
  TextureMemory textures = texture_memory(argument.memory);
  LoadOptions options{
      .confine_paths = !argument.allow_outside, .camera = camera, .textures = &textures, .files = &read};
  if (with_paths || argument.time) options.paths = &loaded.paths;
  if (with_cameras) options.cameras = &loaded.cameras;
  Expected<Scene> scene = load_scene(scene_of_lesson(argument.name), options);
  if (!scene) return fail(scene.error());
  if (const auto apart = files.also_reads(read); !apart) return fail(apart.error());
  if (argument.time) {
    scene = scene_at(*argument.time, std::move(*scene), scene_of_lesson(argument.name), options);
    if (!scene) return fail(scene.error());
  }
  if (tessellate > 0) {
    const std::size_t exact = scene->shapes.size();
    scene = tessellate_shapes(std::move(*scene), tessellate);
    if (scene->shapes.size() == exact && tessellation_is_asked)
      console.note("--tessellate has no effect: no shape but planes is exact");
  }
  loaded.scene = std::make_unique<Scene>(std::move(*scene));
  if (const std::uint64_t count = primitives_of(*loaded.scene); count > raytrace::most_primitives)
    return fail(ErrorKind::bad_input, fmt::format("{}: too many triangles and shapes (got {}, allowed {})",
                                                  argument.name, count, raytrace::most_primitives));
  loaded.world = std::make_unique<World>(make_world(*loaded.scene, argument.instances));
  loaded.plan = plan_effects(*loaded.scene);
  loaded.load_ms = watch.elapsed_ms();
  if (const std::string note = settings_note(argument); !note.empty()) console.note(note);
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
  constexpr std::size_t shown = 16;
  const std::string more =
      names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : std::string();
  const std::string suggestion = did_you_mean(name, names);
  names.resize(std::min(names.size(), shown));
  return fail(ErrorKind::usage, fmt::format("--light: the scene has no such light (got {}, allowed {}{}){}",
                                            name, fmt::join(names, ", "), more, suggestion));
}

namespace {

void say_what_draws(const raster::Context& context, Console& console) {
  if (context.why_not_osmesa().empty()) return;
  console.note(
      fmt::format("OSMesa does not load ({}), so {} draws. --backend {} asks for it at once; Debian's "
                  "libosmesa6 is OSMesa.",
                  context.why_not_osmesa(), context.backend(), context.backend()));
}

}  // namespace

Expected<std::unique_ptr<raster::Context>> make_context(raster::Backend backend, Console& console) {
  if (const auto fits = check_memory({0, 0}, 0.0, graphics_bytes); !fits) return fail(fits.error());
  const TimedStage stage("context");
  auto context = raster::create_context(backend);
  if (context) say_what_draws(**context, console);
  return context;
}

Expected<std::unique_ptr<raster::Renderer>> make_renderer(raster::Backend backend, const LoadedScene& loaded,
                                                          Console& console,
                                                          const std::string& shader_folder) {
  auto context = make_context(backend, console);
  if (!context) return fail(context.error());
  return make_renderer(std::move(*context), loaded, shader_folder);
}

namespace {

void use_rays(raster::Renderer& renderer, const World& world) {
  renderer.use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(world));
  renderer.use_external_visibility(raster::Technique::rays, rays::make_visibility(world));
}

}  // namespace

Expected<std::unique_ptr<raster::Renderer>> make_renderer(std::unique_ptr<raster::Context> context,
                                                          const LoadedScene& loaded,
                                                          const std::string& shader_folder) {
  auto renderer = raster::Renderer::create(std::move(context), *loaded.world, loaded.plan, shader_folder);
  if (renderer) use_rays(**renderer, *loaded.world);
  return renderer;
}

Expected<void> check_shaders_used(const std::string& shader_folder, const raster::RasterFrame& frame,
                                  const Scene& scene, Console& console) {
  if (shader_folder.empty()) return {};
  const auto folder = raster::ShaderFolder::read(shader_folder);
  if (!folder) return fail(folder.error());
  const std::vector<raster::ReplacedShader> replaced = folder->replaced();
  if (replaced.empty())
    console.note(fmt::format("{}: every shader in it is the program's own", shader_folder));
  const std::vector<raster::ReplacedShader>& used = frame.replaced_shaders;
  const raster::MapOptions& map = frame.options.map;
  const std::string file =
      frame.lights.empty() ? "" : raster::technique_file(map, scene.lights[frame.lights.front().light]);
  for (const raster::ReplacedShader& shader : replaced) {
    if (std::find(used.begin(), used.end(), shader) != used.end()) continue;
    const std::string words = fmt::format("replaces nothing here: --technique {} reads {}",
                                          raster::technique_name(map.technique), file);
    if (used.empty()) {
      Error error{ErrorKind::bad_input, words};
      error.file = folder->path_of(shader.name);
      return fail(std::move(error));
    }
    console.note(folder->path_of(shader.name) + " " + words);
  }
  return {};
}

namespace {

/// Counts threads of the ray tracer and of the rasterizer, one that writes files, and two of Mesa's own.
int threads_to_start(int threads) {
  return threads == 1 ? 1 : 2 * threads + 3;
}

}  // namespace

void limit_threads(int threads, Console& console) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int wanted = threads == 0 ? cores : threads, all = threads_to_start(wanted);
  if (const int startable = startable_threads(all); startable < all) {
    threads = std::max(1, (startable - 3) / 2);
    console.note(fmt::format("only {} more threads can be started (a limit on processes); going on with {}",
                             startable, threads));
  }
  if (threads == 0) return;
  limit_loops(threads);
  // Mesa's llvmpipe: 0 draws on the calling thread, N > 0 on N others while the caller waits.
  setenv("LP_NUM_THREADS", threads == 1 ? "0" : std::to_string(threads).c_str(), 1);
}

std::string default_output(const std::string& path_or_name) {
  const std::string name = std::filesystem::path(path_or_name).stem().string();
  return "out/" + (name.empty() ? "scene" : name);
}

}  // namespace gnomon::app
