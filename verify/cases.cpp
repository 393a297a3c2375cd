// The list.
#include "verify/cases.h"

#include <array>

namespace gnomon::verify {

std::span<const Case> all_cases() {
  static constexpr std::array cases{
      Case{1, "shared_edges", "rays from inside a closed mesh at its corners and edges all hit it",
           shared_edges},
      Case{2, "sliver", "a hit on a triangle 1e6 times as long as wide lies where it should", sliver},
      Case{3, "degenerate_triangles", "triangles without area are never hit", degenerate_triangles},
      Case{4, "coplanar_ray", "a ray in a triangle's plane misses it", coplanar_ray},
      Case{5, "distant_sphere", "a sphere is hit or missed as 128 bits say, from any distance",
           distant_sphere},
      Case{6, "tangent_ray", "a tangent ray is ambiguous within rounding only", tangent_ray},
      Case{7, "inside_sphere", "from inside or on a sphere the ray leaves where 128 bits say", inside_sphere},
      Case{8, "direction_length", "the length of the direction does not matter", direction_length},
      Case{9, "steep_plane", "a ray nearly along a plane meets it at a finite place or not", steep_plane},
      Case{10, "slab_faces", "axis-parallel rays in the faces of boxes are not culled", slab_faces},
      Case{11, "slab_corners", "rays at the corners of flat boxes are not culled", slab_corners},
      Case{12, "invalid_rays", "NaN, infinite and zero rays cost nothing", invalid_rays},
      Case{13, "equal_centroids", "duplicates build, and the lowest id wins", equal_centroids},
      Case{14, "few_primitives", "0, 1 and 2 primitives", few_primitives},
      Case{15, "bad_vertices", "NaN and infinite vertices leave the others alone", bad_vertices},
      Case{16, "stadium", "a small mesh in a huge box", stadium},
      Case{17, "split_plane", "triangles in the planes that structures split at", split_plane},
      Case{18, "cell_corners", "rays through the corners of a lattice", cell_corners},
      Case{19, "self_hits", "convex bodies do not meet themselves", self_hits},
      Case{20, "nested_spheres", "a sphere 4e-5 inside another is met", nested_spheres},
      Case{21, "instances", "scaled and sheared instances do not meet themselves", instances},
      Case{22, "light_in_plane", "a light in the receiver's plane does not light it", light_in_plane},
      Case{23, "light_at_vertex", "a surface at the light's own place does not block it", light_at_vertex},
      Case{24, "occluder_at_end", "hits count strictly inside the interval", occluder_at_end},
      Case{25, "light_inside", "a light inside a closed mesh lights nothing outside", light_inside},
      Case{26, "coplanar_duplicates",
           "ties go to the lowest id in any order; twins cast no shadow on each other", coplanar_duplicates},
      Case{27, "contact_gap", "a box's shadow starts at its foot plus the gap", contact_gap},
      Case{28, "smooth_normals", "the geometric normal decides what faces the light", smooth_normals},
      Case{29, "critical_angle", "reflected and transmitted light add up to 1", critical_angle},
      Case{30, "invisible_glass",
           "glass of index 1 is as good as absent; overlapping glass is what its priority says",
           invisible_glass},
      Case{31, "depth_range", "a depth map keeps depths of 1 to 5,000 within its format's quantum",
           depth_range},
      Case{32, "behind_light", "what lies behind a light, or a warp's eye, looks up no texel", behind_light},
      Case{33, "outside_map", "receivers beside the map or beyond its depths are lit, and counted",
           outside_map},
      Case{34, "texel_boundaries", "on the border of two texels one of the two is looked up",
           texel_boundaries},
      Case{35, "cube_seams", "the faces of a cube map meet without gap or overlap", cube_seams},
      Case{36, "bias_convergence", "a receding lamp needs the bias of a sun", bias_convergence},
      Case{37, "far_from_origin", "the scene and its camera at 1e7 give the picture of the origin",
           far_from_origin},
      Case{38, "image_sizes", "pictures of one pixel, of the longest side, and beyond it", image_sizes},
      Case{39, "non_finite_radiance", "radiance that is not a number is black and counted",
           non_finite_radiance},
      Case{40, "shrinking_lights", "a light that shrinks to nothing becomes the hard one", shrinking_lights},
      Case{41, "extreme_bias", "biases of 0, -1e6, 1e30 and NaN, and a map of one texel", extreme_bias},
      Case{42, "scale_invariance", "lengths times a power of two change no drawn shadow", scale_invariance},
      Case{43, "coplanar_lights", "a light in the planes of faces is drawn by izb as certain rays say",
           coplanar_lights},
      Case{44, "stretched_triangles", "the nearer of two sheets 1e6 long and 1e-6 apart is met first",
           stretched_triangles},
  };
  return cases;
}

}  // namespace gnomon::verify
