# The shadow lab's window: gnomon view.
target_sources(gnomon_app PRIVATE
  view/window/frame_watch.cpp view/state/input.cpp view/window/interface.cpp view/window/layout.cpp view/work/meter.cpp
  view/script/script.cpp view/script/script_keys.cpp view/window/style.cpp view/view.cpp view/viewer.cpp view/viewer_files.cpp
  view/viewer_input.cpp view/viewer_script.cpp view/window/window.cpp
  view/panels/columns.cpp view/panels/curve.cpp view/panels/help.cpp view/panels/menu.cpp view/panels/overlay.cpp
  view/panels/probe.cpp view/panels/results.cpp view/panels/settings.cpp view/panels/status_bar.cpp)
# The backends' headers name imgui.h alone.
set_source_files_properties(view/window/interface.cpp PROPERTIES INCLUDE_DIRECTORIES "${IMGUI_INCLUDE_DIRS}")
target_link_libraries(gnomon_app PRIVATE ${IMGUI_LINK_LIBRARIES} glfw TBB::tbb Threads::Threads)
