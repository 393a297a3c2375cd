// A solid's equation in its own frame: value, gradient, the normal at a point and the point put onto the surface. What
// the shading needs; rays are cast in solid.glsl. Permutations QUADRIC, TORUS and IMPLICIT name the kinds that may come;
// IMPLICIT_FUNCTIONS is text that raster/programs/expression_glsl.h makes of the scene's expressions. Needs world.glsl.

#if defined(TORUS) || defined(IMPLICIT)
#define MARCHED
#include "bounds.glsl"
#endif
#ifdef IMPLICIT
IMPLICIT_FUNCTIONS
#endif

const int solid_open = 0, solid_closed = 1, solid_uncut = 2;  // ShapeData.box_max.w
int solid_cut(ShapeData s) { return int(s.box_max.w); }

#ifdef QUADRIC
float quadric_value(ShapeData s, vec3 p) {
  vec4 c = s.coefficients;
  return (c.x * p.x * p.x + c.y * p.y * p.y) + (c.z * p.z * p.z + c.w * p.z) + s.box_min.w;
}
#endif

#ifdef MARCHED
vec4 solid_gradient(ShapeData s, vec3 p) {
#ifdef TORUS
  if (s.kind == uint(shape_torus)) {
    float around = length(p.xy), off = around - s.coefficients.x;
    return vec4(2.0 * off * p.xy / around, 2.0 * p.z, (off - s.coefficients.y) * (off + s.coefficients.y) + p.z * p.z);
  }
#endif
#ifdef IMPLICIT
  return function_gradient(s.function, vec4(1, 0, 0, p.x), vec4(0, 1, 0, p.y), vec4(0, 0, 1, p.z));
#else
  return vec4(0.0);
#endif
}
#endif

// Outward local normal at a local point near the surface, and the point put onto the surface.
vec3 solid_surface(ShapeData s, inout vec3 p) {
  vec4 f;
#ifdef QUADRIC
  if (s.kind == uint(shape_quadric))
    f = vec4(2.0 * s.coefficients.xyz * p + vec3(0.0, 0.0, s.coefficients.w), quadric_value(s, p));
#ifdef MARCHED
  else
#endif
#endif
#ifdef MARCHED
    f = solid_gradient(s, p);
#endif
  float steepness = length(f.xyz), nearest = abs(f.w) / steepness;
  if (isnan(nearest)) nearest = infinite_t;
  int axis = -1;
  float side = 0.0;
  bool all_faces = s.kind == uint(shape_implicit);
  if (solid_cut(s) == solid_closed && s.kind != uint(shape_torus)) {
    for (int a = all_faces ? 0 : 2; a < 3; ++a) {
      float below = abs(p[a] - s.box_min[a]), above = abs(p[a] - s.box_max[a]);
      if (min(below, above) < nearest) {
        nearest = min(below, above);
        axis = a;
        side = below < above ? -1.0 : 1.0;
      }
    }
  }
  vec3 normal = vec3(0.0);
  if (axis >= 0) {
    p[axis] = side < 0.0 ? s.box_min[axis] : s.box_max[axis];
    normal[axis] = side;
    return normal;
  }
  if (!(steepness > 0.0) || isinf(steepness)) return vec3(0.0, 0.0, 1.0);
  vec3 move = f.xyz * (f.w / (steepness * steepness));
  if (dot(move, move) < 1e-6 * dot(s.box_max.xyz - s.box_min.xyz, s.box_max.xyz - s.box_min.xyz)) p -= move;
  return f.xyz / steepness;
}
