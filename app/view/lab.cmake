# The shadow lab itself, of a window and of a page: what it is set to, and what draws and compares it.
target_sources(gnomon_app PRIVATE
  options/lab_options.cpp serve/lab_answers.cpp serve/lab_engine.cpp serve/lab_facts.cpp serve/setting_facts.cpp
  view/state/film.cpp view/state/first_state.cpp view/state/look.cpp view/state/pixel_story.cpp view/state/presets.cpp
  view/state/projection.cpp view/state/save_scene.cpp view/state/state.cpp view/state/status.cpp
  view/work/file_watch.cpp view/work/kept_truth.cpp view/work/map_pictures.cpp view/work/render_thread.cpp view/work/scene_source.cpp view/work/shadow_times.cpp view/work/studio.cpp
  view/work/worker.cpp)
