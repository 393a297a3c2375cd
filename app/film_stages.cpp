#include "app/film_stages.h"

#include "scene/load.h"

namespace gnomon::app {
namespace {

class Stages {
 public:
  Stages(StageSource source, std::string animation)
      : source_(std::move(source)), animation_(std::move(animation)) {}

  Expected<compare::FilmStage> at(double seconds) {
    renderer_.reset();
    auto scene = load_scene(source_.scene.name, {.confine_paths = !source_.scene.allow_outside,
                                                 .camera = source_.camera,
                                                 .animation = animation_,
                                                 .seconds = seconds});
    if (!scene) return fail(scene.error());
    stage_.world.reset();
    stage_.scene = std::make_unique<Scene>(std::move(*scene));
    stage_.world = std::make_unique<World>(make_world(*stage_.scene, source_.scene.instances));
    stage_.plan = plan_effects(*stage_.scene);
    Console quiet(true);  // it was said of the first moment
    auto renderer = make_renderer(source_.backend, stage_, quiet, source_.shader_folder);
    if (!renderer) return fail(renderer.error());
    renderer_ = std::move(*renderer);
    return compare::FilmStage{*stage_.world, *stage_.scene, *renderer_};
  }

 private:
  const StageSource source_;
  const std::string animation_;
  LoadedScene stage_;
  std::unique_ptr<raster::Renderer> renderer_;
};

}  // namespace

std::function<Expected<compare::FilmStage>(double seconds)> stages_of(StageSource source,
                                                                      std::string animation) {
  const auto stages = std::make_shared<Stages>(std::move(source), std::move(animation));
  return [stages](double seconds) { return stages->at(seconds); };
}

}  // namespace gnomon::app
