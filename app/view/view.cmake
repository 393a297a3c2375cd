# The shadow lab: gnomon view.
target_sources(gnomon_app PRIVATE
  view/file_watch.cpp view/film.cpp view/frame_watch.cpp view/input.cpp view/interface.cpp view/job.cpp view/layout.cpp view/look.cpp
  view/map_pictures.cpp view/meter.cpp view/pixel_story.cpp view/presets.cpp view/priority.cpp view/projection.cpp
  view/render_thread.cpp view/save_scene.cpp view/scene_source.cpp view/script.cpp view/script_keys.cpp view/state.cpp
  view/status.cpp view/studio.cpp view/style.cpp view/view.cpp view/viewer.cpp view/viewer_files.cpp
  view/viewer_input.cpp view/viewer_script.cpp view/window.cpp view/worker.cpp
  view/panels/columns.cpp view/panels/curve.cpp view/panels/help.cpp view/panels/menu.cpp view/panels/overlay.cpp
  view/panels/probe.cpp view/panels/results.cpp view/panels/settings.cpp view/panels/status_bar.cpp)
# The backends' headers name imgui.h alone.
set_source_files_properties(view/interface.cpp PROPERTIES INCLUDE_DIRECTORIES "${IMGUI_INCLUDE_DIRS}")
target_link_libraries(gnomon_app PRIVATE ${IMGUI_LINK_LIBRARIES})
