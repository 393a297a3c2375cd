# What a comparison is written as: result.json, CSV, summary, pictures, EXR, report page.
# GNOMON_COMPARE_OUTPUT_SOURCES goes into the room's library gnomon_compare, GNOMON_COMPARE_TEXT_SOURCES into its
# part gnomon_compare_untimed; the rest happens once that exists.
set(GNOMON_COMPARE_OUTPUT_SOURCES
  aov.cpp flip.cpp labels.cpp palette.cpp picture_set.cpp pictures.cpp report/channels.cpp report/colour_numbers.cpp
  report/light_channels.cpp report/light_numbers.cpp report/packing.cpp report/section_mesh.cpp
  report/surface_prediction.cpp)
set(GNOMON_COMPARE_TEXT_SOURCES
  bias_advice.cpp csv_field.cpp engine_units.cpp file_names.cpp number_text.cpp option_names.cpp result_json.cpp
  result_light_json.cpp result_table.cpp shadow_cost.cpp summary.cpp text_layout.cpp time_budget.cpp verdict.cpp
  write_outputs.cpp report/annex.cpp report/bias_tables.cpp report/charts.cpp report/explanations.cpp report/html.cpp
  report/hybrid_block.cpp report/lessons.cpp report/light_section.cpp report/overview.cpp report/page.cpp
  report/page_data.cpp report/page_head.cpp report/pixel_words.cpp report/shadow_cost.cpp report/shell.cpp
  report/time_budget.cpp)
list(TRANSFORM GNOMON_COMPARE_OUTPUT_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
list(TRANSFORM GNOMON_COMPARE_TEXT_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

set_source_files_properties("${CMAKE_CURRENT_LIST_DIR}/option_names.cpp"
  PROPERTIES COMPILE_DEFINITIONS "GNOMON_VERSION=\"${PROJECT_VERSION}\"")

function(gnomon_compare_outputs target)
  set(report "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/report")
  gnomon_embed(${target} report "${report}/page/dist/page.html" "${report}/page/dist/lesson.html" "${report}/phrases.json")  # built by npm run build in report/page, and checked in
  file(GLOB lessons CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/lessons/*.md")
  gnomon_embed(${target} lessons ${lessons})
  target_link_libraries(${target} PRIVATE fmt::fmt nlohmann_json::nlohmann_json)
endfunction()
cmake_language(DEFER CALL gnomon_compare_outputs gnomon_compare)
