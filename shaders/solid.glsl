// Rays against solids in their own frames: quadrics in closed form, tori and implicit surfaces by interval arithmetic, so
// that no root is skipped. Twin of raytrace/solid.h and along_ray.h. Permutations QUADRIC, TORUS and IMPLICIT name the
// kinds that may come; IMPLICIT_FUNCTIONS is text that raster/expression_glsl.h makes of the scene's expressions.
// Accuracy: floats relative to the solid's own size, so about 1e-7 of it across the surface; near a silhouette, where a
// ray grazes, the root of that along the ray. Needs world.glsl.

#if defined(TORUS) || defined(IMPLICIT)
#define MARCHED
#include "bounds.glsl"
#endif
#ifdef IMPLICIT
IMPLICIT_FUNCTIONS
#endif

const int most_sides = 8;  // of a solid that are looked at for one that is no hole and not culled
const int solid_open = 0, solid_closed = 1, solid_uncut = 2;  // ShapeData.box_max.w
int solid_cut(ShapeData s) { return int(s.box_max.w); }

#ifdef QUADRIC
float quadric_value(ShapeData s, vec3 p) {
  vec4 c = s.coefficients;
  return (c.x * p.x * p.x + c.y * p.y * p.y) + (c.z * p.z * p.z + c.w * p.z) + s.box_min.w;
}

// Where f <= 0 along o + t d, as up to two stretches (begin, end); counted from the point nearest to the middle.
int quadric_stretches(ShapeData s, vec3 o, vec3 d, out vec2 a, out vec2 b) {
  vec4 c = s.coefficients;
  float dd = c.x * d.x * d.x + c.y * d.y * d.y + c.z * d.z * d.z;
  float od = c.x * o.x * d.x + c.y * o.y * d.y + c.z * o.z * d.z + 0.5 * c.w * d.z;
  float oo = quadric_value(s, o);
  float discriminant = od * od - dd * oo;
  a = vec2(-infinite_t, infinite_t);
  b = a;
  if (!(discriminant > 0.0)) return oo < 0.0 || dd < 0.0 ? 1 : 0;
  float q = -(od + (od >= 0.0 ? 1.0 : -1.0) * sqrt(discriminant));
  float far = oo / q;
  if (dd == 0.0) {
    a = od > 0.0 ? vec2(-infinite_t, far) : vec2(far, infinite_t);
    return 1;
  }
  vec2 roots = vec2(min(q / dd, far), max(q / dd, far));
  if (dd > 0.0) {
    a = roots;
    return 1;
  }
  a = vec2(-infinite_t, roots.x);
  b = vec2(roots.y, infinite_t);
  return 2;
}

bool quadric_next(ShapeData s, vec3 origin, vec3 d, float from, out float t) {
  t = infinite_t;
  float nearest = -dot(origin - 0.5 * (s.box_min.xyz + s.box_max.xyz), d) / dot(d, d);
  vec3 o = origin + nearest * d;
  vec2 stretch[2];
  int parts = quadric_stretches(s, o, d, stretch[0], stretch[1]);
  vec2 slab = vec2(-infinite_t, infinite_t);
  int cut = solid_cut(s);
  if (cut != solid_uncut && d.z != 0.0) {
    vec2 ends = (vec2(s.box_min.z, s.box_max.z) - o.z) / d.z;
    slab = vec2(min(ends.x, ends.y), max(ends.x, ends.y));
  } else if (cut != solid_uncut && !(o.z >= s.box_min.z && o.z <= s.box_max.z)) {
    return false;
  }
  for (int i = 0; i < parts; ++i) {
    vec2 ends = stretch[i];
    if (cut != solid_open) {
      ends = vec2(max(ends.x, slab.x), min(ends.y, slab.y));
      if (!(ends.x < ends.y)) continue;
    }
    for (int k = 0; k < 2; ++k) {
      if (abs(ends[k]) >= infinite_t || ends[k] < slab.x || ends[k] > slab.y) continue;
      float at = nearest + ends[k];
      if (at > from) t = min(t, at);
    }
  }
  return t < infinite_t;
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

Slope solid_slope(ShapeData s, vec3 o, vec3 d, vec2 range) {
  unsure = false;
  nothing = false;
  Slope x = Slope(i_add(vec2(o.x), i_mul(range, vec2(d.x))), vec2(d.x));
  Slope y = Slope(i_add(vec2(o.y), i_mul(range, vec2(d.y))), vec2(d.y));
  Slope z = Slope(i_add(vec2(o.z), i_mul(range, vec2(d.z))), vec2(d.z));
#ifdef TORUS
  if (s.kind == uint(shape_torus)) {
    Slope around = s_sqrt(s_add(s_power(x, 2), s_power(y, 2)));
    Slope off = s_sub(around, s_constant(s.coefficients.x, s.coefficients.x));
    vec2 rr = outward(vec2(s.coefficients.y * s.coefficients.y));
    return s_sub(s_add(s_power(off, 2), s_power(z, 2)), s_constant(rr.x, rr.y));
  }
#endif
#ifdef IMPLICIT
  return function_slope(s.function, x, y, z);
#else
  return x;
#endif
}

// The root between two places where f differs in sign: false position with halved weights (Dowell and Jarratt 1971,
// "Illinois").
float solve_between(ShapeData s, vec3 o, vec3 d, vec2 at, vec2 f) {
  float middle = 0.5 * (at.x + at.y);
  for (int i = 0; i < 24; ++i) {
    middle = (f.y * at.x - f.x * at.y) / (f.y - f.x);
    if (!(middle > at.x && middle < at.y)) middle = 0.5 * (at.x + at.y);
    if (!(middle > at.x && middle < at.y)) break;
    float value = solid_gradient(s, o + middle * d).w;
    if (value == 0.0) break;
    if ((value < 0.0) == (f.x < 0.0)) {
      at.x = middle;
      f.x = value;
      f.y *= 0.5;
    } else {
      at.y = middle;
      f.y = value;
      f.x *= 0.5;
    }
  }
  return middle;
}

bool march_next(ShapeData s, vec3 origin, vec3 d, float from, out float t) {
  const int most_stretches = 512;
  t = infinite_t;
  vec3 low = (s.box_min.xyz - origin) / d, high = (s.box_max.xyz - origin) / d;
  vec3 first = min(low, high), last = max(low, high);
  for (int a = 0; a < 3; ++a) {
    if (d[a] != 0.0) continue;
    bool within = origin[a] >= s.box_min[a] && origin[a] <= s.box_max[a];
    first[a] = within ? -infinite_t : infinite_t;
    last[a] = -first[a];
  }
  vec2 range = vec2(max(first.x, max(first.y, first.z)), min(last.x, min(last.y, last.z)));
  if (!(range.x < range.y) || !(from < range.y)) return false;
  vec3 o = origin + range.x * d;  // counted from where the ray enters the box
  float end = range.y - range.x, at = max(from - range.x, 0.0);
  bool closed = s.kind == uint(shape_implicit) && solid_cut(s) == solid_closed;
  if (closed && from < range.x && solid_gradient(s, o).w < 0.0) {
    t = range.x;
    return true;
  }
  float longest = 0.125 * end, step = longest, least = end * 9.5e-7;
  for (int n = 0; n < most_stretches && at < end; ++n) {
    float to = min(at + step, end);
    if (!(to > at)) break;
    Slope f = solid_slope(s, o, d, vec2(at, to));
    if (!(nothing || f.v.x > 0.0 || f.v.y < 0.0)) {
      bool monotone = !unsure && (f.d.x > 0.0 || f.d.y < 0.0);
      bool sure = !unsure;
      float middle = 0.5 * (at + to);
      if (monotone) {
        vec2 ends = vec2(solid_gradient(s, o + at * d).w, solid_gradient(s, o + to * d).w);
        if ((ends.x < 0.0 && ends.y >= 0.0) || (ends.x > 0.0 && ends.y <= 0.0)) {
          t = range.x + solve_between(s, o, d, vec2(at, to), ends);
          return true;
        }
      } else {
        vec2 here = solid_slope(s, o, d, vec2(middle)).v;
        bool rounding = !(here.x > 0.0 || here.y < 0.0) && f.v.y - f.v.x <= 4.0 * (here.y - here.x);
        if (!rounding && step > least) {
          step *= 0.5;
          continue;
        }
        if (sure) {  // a touch, or a crossing too flat to tell where
          t = range.x + middle;
          return true;
        }
      }
    }
    at = to;
    step = min(2.0 * step, longest);
  }
  if (closed && from < range.y && solid_gradient(s, o + end * d).w < 0.0) {
    t = range.y;
    return true;
  }
  return false;
}
#endif

// The first crossing after `from`, in multiples of the local direction.
bool solid_next(ShapeData s, vec3 origin, vec3 direction, float from, out float t) {
#ifdef QUADRIC
  if (s.kind == uint(shape_quadric)) return quadric_next(s, origin, direction, from, t);
#endif
#ifdef MARCHED
  return march_next(s, origin, direction, from, t);
#else
  t = 0.0;
  return false;
#endif
}

// Where to go on looking after a crossing at t that does not count.
float solid_after(ShapeData s, vec3 direction, float t) {
  return t + 1e-5 * length(s.box_max.xyz - s.box_min.xyz) / length(direction);
}

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
