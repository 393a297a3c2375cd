# gnomon lessons: the lessons as a site, and lectures made of their parts. Their text is embedded with the report, their
# pictures and the decks here.
target_sources(gnomon_app PRIVATE
  commands/lessons.cpp lessons/comparison.cpp lessons/figures.cpp lessons/flatland.cpp lessons/intersection.cpp lessons/lecture.cpp lessons/lesson_text.cpp lessons/markdown.cpp lessons/site.cpp lessons/structure.cpp)
file(GLOB lesson_images CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/images/*.png" "${PROJECT_SOURCE_DIR}/docs/images/*.svg")
gnomon_embed(gnomon_app lesson_images ${lesson_images})
file(GLOB lectures CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/lectures/en/*.md")
gnomon_embed(gnomon_app lectures ${lectures})
target_link_libraries(gnomon_app PRIVATE md4c_html)
