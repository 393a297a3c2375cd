# What grade writes and runs: the page's style, its mistakes and the kits for teachers.
gnomon_embed(gnomon_studies grade_page grade/page.css)
gnomon_embed(gnomon_studies grade_mistakes grade/mistakes/hard.glsl grade/mistakes/pcf_box.glsl
  grade/mistakes/eye_ray.glsl grade/mistakes/ray_sphere.glsl grade/mistakes/ray_plane.glsl grade/mistakes/ray_triangle.glsl grade/mistakes/ray_box.glsl
  grade/mistakes/reflection.glsl grade/mistakes/refraction.glsl grade/mistakes/fresnel.glsl
  grade/mistakes/shadow_ray.glsl
  grade/mistakes/grid_step.glsl grade/mistakes/bvh_walk.glsl grade/mistakes/bvh_split.glsl)
gnomon_embed(gnomon_studies grade_kits KEEP_PATHS
  grade/kits/first-shadow-map/README.md grade/kits/first-shadow-map/rubric.json
  grade/kits/first-shadow-map/horizon.json grade/kits/first-shadow-map/lamp.json grade/kits/first-shadow-map/stage.json
  grade/kits/first-shadow-map/shadow_map.glsl grade/kits/first-shadow-map/technique/hard.glsl
  grade/kits/percentage-closer-filtering/README.md grade/kits/percentage-closer-filtering/rubric.json
  grade/kits/percentage-closer-filtering/technique/pcf_box.glsl
  grade/kits/rays-and-light/README.md grade/kits/rays-and-light/rubric.json
  grade/kits/rays-and-structures/README.md grade/kits/rays-and-structures/rubric.json
  grade/kits/rays-and-surfaces/README.md grade/kits/rays-and-surfaces/rubric.json)
