# The viewer: its state, keys and scripts without a display, and the window itself under Xvfb.
gnomon_test(view_test SOURCES view_pose_test.cpp view_state_test.cpp view_input_test.cpp view_script_test.cpp
  view_rows_test.cpp view_status_test.cpp view_facts_test.cpp view_film_test.cpp view_text_test.cpp view_times_test.cpp
  LIBS app_process gnomon::lab gnomon::scene glfw)
add_dependencies(view_test gnomon_programs)

gnomon_test(view_thread_gl_test SOURCES view_thread_gl_test.cpp view_story_gl_test.cpp
  LIBS app_process gnomon::lab gnomon::compare gnomon::raster gnomon::scene)

# One thread's turns, which the test takes: objects of its own stand for those of the library.
gnomon_test(view_turns_gl_test SOURCES view_turns_gl_test.cpp ../../platform/web/turns.cpp
  LIBS app_process gnomon::lab gnomon::compare gnomon::raster gnomon::scene)
set_target_properties(view_turns_gl_test PROPERTIES UNITY_BUILD OFF)

# Each its own program: together they would take too long on a busy machine.
foreach(subject window lab keys opened)
  gnomon_test(view_${subject}_gl_test SOURCES view_${subject}_gl_test.cpp view_display.cpp
    LIBS app_process gnomon::compare gnomon::scene)
  add_dependencies(view_${subject}_gl_test gnomon_programs)
endforeach()
# Some of their files have names in common.
set_target_properties(view_test view_thread_gl_test PROPERTIES UNITY_BUILD OFF)
