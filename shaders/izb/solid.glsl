// A solid's equation in double precision and in its own frame: value, gradient, normal. Twin of scene/shapes/solid.cpp.
// Permutations QUADRIC, TORUS and IMPLICIT name the kinds that may come; IMPLICIT_FUNCTIONS is text that
// raster/programs/expression_glsl.h makes of the scene's expressions. Needs izb.glsl and world.glsl.

#ifdef IMPLICIT
#include "izb/functions.glsl"
#endif
#if defined(TORUS) || defined(IMPLICIT)
#ifndef NO_SLOPES
#include "bounds.glsl"
#endif
#endif
#ifdef IMPLICIT
IMPLICIT_FUNCTIONS
#endif

const int solid_open = 0, solid_closed = 1, solid_uncut = 2;  // DoubleShape.box_max.w
int solid_cut64(DoubleShape s) { return int(s.box_max.w); }

dvec3 to_solid64(DoubleShape s, dvec3 v) { return dvec3(dot(s.tangent.xyz, v), dot(s.bitangent.xyz, v), dot(s.normal.xyz, v)); }
dvec3 from_solid64(DoubleShape s, dvec3 v) { return v.x * s.tangent.xyz + v.y * s.bitangent.xyz + v.z * s.normal.xyz; }

double quadric_value64(DoubleShape s, dvec3 p) {
  dvec4 c = s.coefficients;
  return (c.x * p.x * p.x + c.y * p.y * p.y) + (c.z * p.z * p.z + c.w * p.z) + s.box_min.w;
}

// Gradient and value.
dvec4 solid_gradient64(ShapeData shape, DoubleShape s, dvec3 p) {
#ifdef QUADRIC
  if (shape.kind == uint(shape_quadric))
    return dvec4(2.0LF * s.coefficients.xyz * p + dvec3(0.0LF, 0.0LF, s.coefficients.w), quadric_value64(s, p));
#endif
#ifdef TORUS
  if (shape.kind == uint(shape_torus)) {
    double around = sqrt(dot(p.xy, p.xy)), off = around - s.coefficients.x;
    return dvec4(2.0LF * off * p.xy / around, 2.0LF * p.z, (off - s.coefficients.y) * (off + s.coefficients.y) + p.z * p.z);
  }
#endif
#ifdef IMPLICIT
  return function_gradient64(shape.function, dvec4(1, 0, 0, p.x), dvec4(0, 1, 0, p.y), dvec4(0, 0, 1, p.z));
#else
  return dvec4(0.0LF);
#endif
}

// The axis across which a point near the surface lies on a cap, and the cap's place on it; -1: on the surface of f, whose
// value and gradient are given.
int nearest_cap(ShapeData shape, DoubleShape s, dvec3 p, dvec4 f, out double cap) {
  double nearest = abs(f.w) / sqrt(dot(f.xyz, f.xyz));
  if (isnan(nearest) || isinf(nearest)) nearest = no_end;
  cap = 0.0LF;
  int axis = -1;
  if (solid_cut64(s) != solid_closed || shape.kind == uint(shape_torus)) return axis;
  bool all_faces = shape.kind == uint(shape_implicit);
  for (int a = all_faces ? 0 : 2; a < 3; ++a) {
    double below = abs(p[a] - s.box_min[a]), above = abs(p[a] - s.box_max[a]);
    if (min(below, above) < nearest) {
      nearest = min(below, above);
      axis = a;
      cap = below <= above ? s.box_min[a] : s.box_max[a];
    }
  }
  return axis;
}

// Outward unit normal at a local point on the surface, in the world.
dvec3 solid_normal64(ShapeData shape, DoubleShape s, dvec3 p) {
  dvec4 f = solid_gradient64(shape, s, p);
  double cap;
  int axis = nearest_cap(shape, s, p, f, cap);
  if (axis >= 0) {
    dvec3 n = dvec3(0.0LF);
    n[axis] = cap == s.box_max[axis] ? 1.0LF : -1.0LF;
    return from_solid64(s, n);
  }
  double steepness = sqrt(dot(f.xyz, f.xyz));
  return steepness > 0.0LF && !isinf(steepness) ? from_solid64(s, f.xyz / steepness) : s.normal.xyz;
}

double box_diagonal64(DoubleShape s) {
  dvec3 extent = s.box_max.xyz - s.box_min.xyz;
  return sqrt(dot(extent, extent));
}
