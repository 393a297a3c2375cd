// One function per case; cases.cpp lists them.
#pragma once

#include "scene/math.h"
#include "scene/world.h"
#include "verify/run.h"

namespace gnomon::verify {

void shared_edges(Run& run);  // case_shared_edges.cpp
void light_inside(Run& run);
void sliver(Run& run);  // case_triangles.cpp
void degenerate_triangles(Run& run);
void coplanar_ray(Run& run);
void distant_sphere(Run& run);  // case_spheres.cpp
void tangent_ray(Run& run);
void inside_sphere(Run& run);
void nested_spheres(Run& run);
void direction_length(Run& run);  // case_rays.cpp
void steep_plane(Run& run);
void invalid_rays(Run& run);
void slab_faces(Run& run);  // case_boxes.cpp
void slab_corners(Run& run);
void equal_centroids(Run& run);  // case_structures.cpp
void few_primitives(Run& run);
void bad_vertices(Run& run);
void stadium(Run& run);
void split_plane(Run& run);
void cell_corners(Run& run);
void self_hits(Run& run);  // case_offsets.cpp
void instances(Run& run);
void light_in_plane(Run& run);  // case_lights.cpp
void light_at_vertex(Run& run);
void occluder_at_end(Run& run);
void coplanar_duplicates(Run& run);
void contact_gap(Run& run);
void smooth_normals(Run& run);
void critical_angle(Run& run);  // case_glass.cpp
void invisible_glass(Run& run);
void nested_glass(Run& run);            // case_nested_glass.cpp, a row of case 30
void triangles_by_rationals(Run& run);  // case_rational.cpp, rows of case 1
void shadows_by_rationals(Run& run);
void depth_range(Run& run);  // case_map_depth.cpp
void extreme_bias(Run& run);
void behind_light(Run& run);  // case_map_places.cpp
void outside_map(Run& run);
void texel_boundaries(Run& run);
void cube_seams(Run& run);
void bias_convergence(Run& run);  // case_map_sizes.cpp
void image_sizes(Run& run);
void far_from_origin(Run& run);      // case_far.cpp
void non_finite_radiance(Run& run);  // case_radiance.cpp
void shrinking_lights(Run& run);     // case_small_lights.cpp

// The cases of case_invariance.cpp and case_stretched.cpp, declared apart from the others.

void scale_invariance(Run& run);
void coplanar_lights(Run& run);
void stretched_triangles(Run& run);  // case_stretched.cpp

// The nearest hit of a ray as Moeller-Trumbore and the textbook quadratic see it in 128 bits, over every
// primitive in turn.

struct OracleHit {
  double t = 0.0;
  std::uint32_t primitive = no_id;
  bool doubtful = false;  ///< so close to an edge, a tangent or another hit that doubles may choose otherwise
};
/// Triangles and spheres, of sizes from 0.01 to 10 and within 1e2 of the ray's origin.
OracleHit oracle_closest(const World& world, const Ray& ray);

}  // namespace gnomon::verify
