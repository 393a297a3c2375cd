// Rays against solids in their own frames: quadrics in closed form, tori and implicit surfaces by interval arithmetic, so
// that no root is skipped. Twin of raytrace/shapes/solid.h and along_ray.h. Accuracy: floats relative to the solid's own size, so
// about 1e-7 of it across the surface; near a silhouette, where a ray grazes, the root of that along the ray. Compilers
// copy a function to each place that calls it: the long ones are called from one place each.
#include "solid_surface.glsl"

const int most_sides = 8;  // of a solid that are looked at for one that is no hole and not culled

#ifdef QUADRIC
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
#include "solid_slope.glsl"

// Where f changes its sign between two places, if it does: false position with halved weights (Dowell and Jarratt 1971,
// "Illinois"). The first two rounds look at the ends.
bool solve_between(ShapeData s, vec3 o, vec3 d, vec2 at, out float middle) {
  vec2 f = vec2(0.0);
  for (int i = 0; i < 26; ++i) {
    if (i < 2) {
      middle = i == 0 ? at.x : at.y;
    } else {
      middle = (f.y * at.x - f.x * at.y) / (f.y - f.x);
      if (!(middle > at.x && middle < at.y)) middle = 0.5 * (at.x + at.y);
      if (!(middle > at.x && middle < at.y)) break;
    }
    float value = solid_gradient(s, o + middle * d).w;
    if (i == 0) {
      f.x = value;
    } else if (i == 1) {
      f.y = value;
      if (!((f.x < 0.0 && f.y >= 0.0) || (f.x > 0.0 && f.y <= 0.0))) return false;
    } else if (value == 0.0) {
      break;
    } else if ((value < 0.0) == (f.x < 0.0)) {
      at.x = middle;
      f.x = value;
      f.y *= 0.5;
    } else {
      at.y = middle;
      f.y = value;
      f.x *= 0.5;
    }
  }
  return true;
}

// Where the ray is in the solid's box. A torus touches its own, and is looked for in a larger one: what begins on the
// surface would miss it.
vec2 box_range(ShapeData s, vec3 origin, vec3 d) {
  float margin = s.kind == uint(shape_torus) ? 1e-3 * s.box_max.z : 0.0;
  vec3 low = (s.box_min.xyz - margin - origin) / d, high = (s.box_max.xyz + margin - origin) / d;
  vec3 first = min(low, high), last = max(low, high);
  for (int a = 0; a < 3; ++a) {
    if (d[a] != 0.0) continue;
    bool within = origin[a] >= s.box_min[a] - margin && origin[a] <= s.box_max[a] + margin;
    first[a] = within ? -infinite_t : infinite_t;
    last[a] = -first[a];
  }
  return vec2(max(first.x, max(first.y, first.z)), min(last.x, min(last.y, last.z)));
}

// Whether the ray is within the solid where it enters the box, and where it leaves it.
bvec2 within_at_ends(ShapeData s, vec3 o, vec3 d, float end) {
  bvec2 within;
  for (int k = 0; k < 2; ++k) within[k] = solid_gradient(s, o + (k == 0 ? 0.0 : end) * d).w < 0.0;
  return within;
}

// Stretch by stretch, each of which is passed over (no root), solved (f is monotone there) or halved; `probing` looks at
// the middle of one that is neither, for what rounding alone makes of it.
bool march_next(ShapeData s, vec3 origin, vec3 d, float from, out float t) {
  const int most_stretches = 512;
  t = infinite_t;
  vec2 range = box_range(s, origin, d);
  if (!(range.x < range.y) || !(from < range.y)) return false;
  vec3 o = origin + range.x * d;  // counted from where the ray enters the box
  float end = range.y - range.x, at = max(from - range.x, 0.0);
  bool closed = s.kind == uint(shape_implicit) && solid_cut(s) == solid_closed;
  bvec2 within = bvec2(false);
  if (closed) within = within_at_ends(s, o, d, end);
  if (within.x && from < range.x) {
    t = range.x;
    return true;
  }
  float longest = 0.125 * end, step = longest, least = end * 9.5e-7;
  bool probing = false, sure = true;
  vec2 bounds = vec2(0.0);
  for (int n = 0; at < end && (n < most_stretches || probing);) {
    float to = min(at + step, end);
    if (!(to > at)) break;
    float middle = 0.5 * (at + to);
    Slope f = solid_slope(s, o, d, probing ? vec2(middle) : vec2(at, to), 0.0);
    if (probing) {
      probing = false;
      bool rounding = !(f.v.x > 0.0 || f.v.y < 0.0) && bounds.y - bounds.x <= 4.0 * (f.v.y - f.v.x);
      if (!rounding && step > least) {
        step *= 0.5;
        continue;
      }
      if (sure) {  // a touch, or a crossing too flat to tell where
        t = range.x + middle;
        return true;
      }
    } else {
      ++n;
      if (!(nothing || f.v.x > 0.0 || f.v.y < 0.0)) {
        sure = !ambiguous;
        bounds = f.v;
        probing = !(sure && (f.d.x > 0.0 || f.d.y < 0.0));
        if (probing) continue;
        float root;
        if (solve_between(s, o, d, vec2(at, to), root)) {
          t = range.x + root;
          return true;
        }
      }
    }
    at = to;
    step = min(2.0 * step, longest);
  }
  if (within.y && from < range.y) {
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
