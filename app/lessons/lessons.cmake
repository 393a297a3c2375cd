# The lessons' figures, which the program for the web computes as well.
target_sources(gnomon_app PRIVATE
  lessons/comparison.cpp lessons/eye_ray.cpp lessons/figures.cpp lessons/flatland.cpp lessons/grid_curve.cpp lessons/intersection.cpp lessons/lesson_text.cpp lessons/structure.cpp)
if(NOT GNOMON_PLATFORM STREQUAL native)
  return()
endif()
# gnomon lessons: the lessons as a site, and lectures made of their parts. Their text is embedded with the report, their
# pictures and the decks here.
target_sources(gnomon_app PRIVATE
  commands/lessons.cpp commands/site.cpp lessons/lecture.cpp lessons/manual_pages.cpp lessons/markdown.cpp lessons/site.cpp)
file(GLOB lesson_images CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/images/*.png" "${PROJECT_SOURCE_DIR}/docs/images/*.svg")
gnomon_embed(gnomon_app lesson_images ${lesson_images})
file(GLOB lectures CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/lectures/${GNOMON_LANGUAGE}/*.md" "${PROJECT_SOURCE_DIR}/docs/lectures/${GNOMON_LANGUAGE}/figures.json")
gnomon_embed(gnomon_app lectures ${lectures})
target_link_libraries(gnomon_app PRIVATE md4c_html)
# gnomon site has the manual and the lab besides, with the program for the web where ./gnomon web builds it.
file(GLOB manual_pages CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/manual/*.md")
gnomon_embed(gnomon_app manual_pages ${manual_pages} "${PROJECT_SOURCE_DIR}/docs/labels.md" "${PROJECT_SOURCE_DIR}/docs/glossary.md")
gnomon_embed(gnomon_app page_scripts "${PROJECT_SOURCE_DIR}/adapters/open_in_lab.mjs")
set_source_files_properties(commands/site.cpp PROPERTIES COMPILE_DEFINITIONS "GNOMON_WEB_PROGRAM=\"${PROJECT_SOURCE_DIR}/build/web/app\""
  SKIP_UNITY_BUILD_INCLUSION ON)
set_source_files_properties(lessons/site.cpp PROPERTIES COMPILE_DEFINITIONS "GNOMON_LANGUAGE=\"${GNOMON_LANGUAGE}\"" SKIP_UNITY_BUILD_INCLUSION ON)
