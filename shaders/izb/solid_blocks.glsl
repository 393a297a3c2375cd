// Whether a shadow ray crosses a solid. A quadric is decided in closed form. Of a torus or an implicit surface bounds in floats
// (solid_slope.glsl) pass over what is surely free, and the signs of the double-precision function decide where they leave
// it open. So no crossing is skipped that floats could not tell from none. Twin of raytrace/shapes/solid.cpp and solid_visibility.cpp.
#include "izb/solid.glsl"

// How the ray's start lies to the solid that it leaves: 1 outside, -1 inside; 0 where it starts elsewhere. The start itself is
// no crossing: of its own solid a ray from outside must enter first, and one from inside leave.

#ifdef QUADRIC
// Where f <= 0 along o + t d, as up to two stretches (begin, end).
int quadric_stretches64(DoubleShape s, dvec3 o, dvec3 d, out dvec2 a, out dvec2 b) {
  dvec4 c = s.coefficients;
  double dd = c.x * d.x * d.x + c.y * d.y * d.y + c.z * d.z * d.z;
  double od = c.x * o.x * d.x + c.y * o.y * d.y + c.z * o.z * d.z + 0.5LF * c.w * d.z;
  double oo = quadric_value64(s, o);
  double discriminant = od * od - dd * oo;
  a = dvec2(-no_end, no_end);
  b = a;
  if (!(discriminant > 0.0LF)) return oo < 0.0LF || dd < 0.0LF ? 1 : 0;
  double q = -(od + (od >= 0.0LF ? 1.0LF : -1.0LF) * sqrt(discriminant));
  double far = oo / q;
  if (dd == 0.0LF) {
    a = od > 0.0LF ? dvec2(-no_end, far) : dvec2(far, no_end);
    return 1;
  }
  dvec2 roots = dvec2(min(q / dd, far), max(q / dd, far));
  if (dd > 0.0LF) {
    a = roots;
    return 1;
  }
  a = dvec2(-no_end, roots.x);
  b = dvec2(roots.y, no_end);
  return 2;
}

// The first crossing in (0, end).
bool solid_crossed(ShapeData shape, DoubleShape s, dvec3 origin, dvec3 d, double end, int own, out double t) {
  t = no_end;
  double nearest = -dot(origin - 0.5LF * (s.box_min.xyz + s.box_max.xyz), d) / dot(d, d);
  dvec3 o = origin + nearest * d;
  dvec2 stretch[2];
  int parts = quadric_stretches64(s, o, d, stretch[0], stretch[1]);
  dvec2 slab = dvec2(-no_end, no_end);
  int cut = solid_cut64(s);
  if (cut != solid_uncut && d.z != 0.0LF) {
    dvec2 ends = (dvec2(s.box_min.z, s.box_max.z) - o.z) / d.z;
    slab = dvec2(min(ends.x, ends.y), max(ends.x, ends.y));
  } else if (cut != solid_uncut && !(o.z >= s.box_min.z && o.z <= s.box_max.z)) {
    return false;
  }
  for (int i = 0; i < 2; ++i) {
    dvec2 ends = i == 0 ? stretch[0] : stretch[1];
    if (cut != solid_open) ends = dvec2(max(ends.x, slab.x), min(ends.y, slab.y));
    if (i >= parts || !(ends.x < ends.y)) continue;
    bool begins = own >= 0 && abs(ends.x) < no_end && ends.x >= slab.x && ends.x <= slab.y;
    bool ceases = own <= 0 && abs(ends.y) < no_end && ends.y >= slab.x && ends.y <= slab.y;
    if (begins && nearest + ends.x > 0.0LF) t = min(t, nearest + ends.x);
    if (ceases && nearest + ends.y > 0.0LF) t = min(t, nearest + ends.y);
  }
  return t < end;
}
#else
#include "solid_slope.glsl"

// Whether f changes its sign in a stretch: between its ends, or by reaching over 0 and back at an extremum, which the sign of
// f's slope brackets. `inside`: f < 0 at the stretch's begin, and on return at its end. Not `sure`: a change may be a jump.
bool changes_sign(ShapeData shape, DoubleShape s, dvec3 o, dvec3 d, dvec2 stretch, bool monotone, bool sure,
                  inout bool inside) {
  const int halvings = 56;
  const double least_share = 1e-15LF;  // of the box: nearer to the surface than this, rounding says on which side
  double side = inside ? -1.0LF : 1.0LF;
  dvec2 bracket = stretch;
  for (int i = -2; i < halvings; ++i) {
    double at = i == -2 ? stretch.y : i == -1 ? stretch.x : 0.5LF * (bracket.x + bracket.y);
    dvec4 f = solid_gradient64(shape, s, o + at * d);
    bool told = abs(f.w) > least_share * box_diagonal64(s) * sqrt(dot(f.xyz, f.xyz));
    bool inside_here = told ? f.w < 0.0LF : inside;
    if (i != -1 && inside_here != inside) {
      if (i == -2) inside = inside_here;
      return sure;
    }
    double slope = side * dot(f.xyz, d);
    if (i == -2 && (monotone || !(slope > 0.0LF))) return false;
    if (i == -1 && !(slope < 0.0LF)) return false;
    if (i >= 0) bracket = slope < 0.0LF ? dvec2(at, bracket.y) : dvec2(bracket.x, at);
  }
  return false;
}

// A torus touches its box, and is looked for in a larger one (solid.glsl).
dvec2 box_range64(ShapeData shape, DoubleShape s, dvec3 origin, dvec3 d) {
  double margin = shape.kind == uint(shape_torus) ? 1e-3LF * s.box_max.z : 0.0LF;
  dvec3 least = s.box_min.xyz - margin, most = s.box_max.xyz + margin;
  dvec2 range = dvec2(-no_end, no_end);
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0.0LF) {
      if (!(origin[a] >= least[a] && origin[a] <= most[a])) range = dvec2(no_end, -no_end);
      continue;
    }
    double low = (least[a] - origin[a]) / d[a], high = (most[a] - origin[a]) / d[a];
    range = dvec2(max(range.x, min(low, high)), min(range.y, max(low, high)));
  }
  return range;
}

// A crossing in (0, end): t lies in its stretch.
bool solid_crossed(ShapeData shape, DoubleShape s, dvec3 origin, dvec3 d, double end, int own, out double t) {
  const int most_stretches = 4096;
  const float float_share = 5e-7;  // of the box: more than floats round a place in it, the direction and the radii by
  dvec2 range = box_range64(shape, s, origin, d);
  double begin = max(range.x, 0.0LF), to_go = min(range.y, end) - begin;
  t = begin;
  if (!(range.x < range.y) || !(to_go > 0.0LF)) return false;
  dvec3 o = origin + begin * d;
  bool closed = shape.kind == uint(shape_implicit) && solid_cut64(s) == solid_closed;
  bool inside = own != 0 ? own < 0 : solid_gradient64(shape, s, o).w < 0.0LF;
  if (closed && inside && own == 0 && range.x > 0.0LF) return true;  // through the box's face
  float error = float_share * float(box_diagonal64(s));
  vec3 near_o = vec3(o), near_d = vec3(d);
  double longest = 0.125LF * to_go, step = longest, least = to_go * 3.0517578125e-5LF, at = 0.0LF;
  for (int n = 0; n < most_stretches && at < to_go; ++n) {
    double to = min(at + step, to_go);
    if (!(to > at)) break;
    Slope f = solid_slope(shape, near_o, near_d, vec2(float(at), float(to)), error);
    bool free = nothing || f.v.x > 0.0 || f.v.y < 0.0;
    bool monotone = !ambiguous && (f.d.x > 0.0 || f.d.y < 0.0);
    if (!free && !monotone && step > least) {
      step *= 0.5LF;
      continue;
    }
    if (!free && changes_sign(shape, s, o, d, dvec2(at, to), monotone, !ambiguous, inside)) {
      t = begin + at;
      return true;
    }
    at = to;
    step = min(2.0LF * step, longest);
  }
  t = range.y;
  return closed && inside && range.y < end;
}
#endif
