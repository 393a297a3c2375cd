gnomon_test(compare_closed_form_gl_test TIMEOUT 900
  SOURCES compare_closed_form_gl_test.cpp compare_units_test.cpp support/compare_support.cpp support/small_scenes.cpp
  LIBS gnomon::compare)
target_include_directories(compare_closed_form_gl_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
