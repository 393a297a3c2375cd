# gnomon lessons: the lessons as a site. Their text is embedded with the report, their pictures here.
target_sources(gnomon_app PRIVATE
  commands/lessons.cpp lessons/comparison.cpp lessons/figures.cpp lessons/flatland.cpp lessons/intersection.cpp lessons/lesson_text.cpp lessons/markdown.cpp lessons/site.cpp lessons/structure.cpp)
file(GLOB lesson_images CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/images/*.png" "${PROJECT_SOURCE_DIR}/docs/images/*.svg")
gnomon_embed(gnomon_app lesson_images ${lesson_images})
target_link_libraries(gnomon_app PRIVATE md4c_html)
