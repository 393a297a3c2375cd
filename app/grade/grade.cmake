# gnomon grade: rubrics, students, and the kits that come with the program.
target_sources(gnomon_app PRIVATE
  commands/grade.cpp
  grade/check_runs.cpp grade/excerpt.cpp grade/figures.cpp grade/grade.cpp grade/kits.cpp grade/limited_process.cpp
  grade/page.cpp grade/page_name.cpp grade/results.cpp grade/rubric.cpp grade/student.cpp)
gnomon_embed(gnomon_app grade_page grade/page.css)
gnomon_embed(gnomon_app grade_kits KEEP_PATHS
  grade/kits/first-shadow-map/README.md grade/kits/first-shadow-map/rubric.json
  grade/kits/first-shadow-map/horizon.json grade/kits/first-shadow-map/lamp.json grade/kits/first-shadow-map/stage.json
  grade/kits/first-shadow-map/technique/hard.glsl
  grade/kits/percentage-closer-filtering/README.md grade/kits/percentage-closer-filtering/rubric.json
  grade/kits/percentage-closer-filtering/technique/pcf_box.glsl)
