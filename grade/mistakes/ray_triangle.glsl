// A ray against a triangle as a student writes it (Möller and Trumbore 1997), with the usual mistakes: MISTAKE is the number of
// one, 0 of none. The grader reads this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: u could be less than 0
// mistake 2: v could be less than 0
// mistake 3: u + v could be more than 1 (a parallelogram, u and v up to 1 each)
// mistake 4: the triangle had no third edge (neither u + v nor u nor v has an end)
// mistake 5: the whole plane was the triangle
// mistake 6: a triangle behind the ray was met
// mistake 7: a triangle behind the ray was met, at a positive t
// mistake 8: a triangle that is seen from the back was not there
// mistake 9: a triangle that is seen from the front was not there
// mistake 10: the ray were parallel to a small triangle (what counts as 0 is too large)
// mistake 11: a ray that is nearly parallel met nothing (what counts as 0 is too large)
// mistake 12: a parallel ray met the triangle (no test for 0)
// mistake 13: t was a length (the direction is normalized first)
// mistake 14: t was not divided by the determinant
// mistake 15: u and v were not divided by the determinant
// mistake 16: u and v were exchanged against their edges
// mistake 17: the triangle's corner a was at the origin of the world
// mistake 18: a was left out of the edges (b and c are taken for b - a and c - a)
// mistake 19: the determinant had the wrong sign
// mistake 20: the cross product was the wrong way round
// mistake 21: the answer was u
// mistake 22: a ray that meets nothing was answered with 0
// mistake 23: only u and v up to 1 were tested, and not below 0
// mistake 24: u + v had to be less than a half
// mistake 25: the edge from a to b was tested from c
// mistake 26: the edge from b to c was tested from a
// mistake 27: the edge from c to a was tested from b
// mistake 28: the edge from a to b ran from b to a
// mistake 29: the edge from b to c ran from c to b
// mistake 30: the edge from c to a ran from a to c
// mistake 31: the ray began at the origin of the world
// mistake 32: the triangle was its box
// mistake 33: u + v could be up to 2
// mistake 34: a ray that meets nothing was answered with a very large number
// mistake 35: the normal was the product of two corners, not of two edges
// mistake 36: a triangle behind the ray was met, at a positive t (which comes before u and v)
// mistake 37: the edge to c began at b
// mistake 38: the way from a to the ray's begin was turned round
// mistake 39: u, v and t were multiplied by the determinant, not divided
// mistake 40: the three areas were held against the whole too coarsely (what counts as equal is too large)
// mistake 41: the three areas were held against the whole too coarsely (what counts as equal is too large)
// mistake 42: the three areas were held against the whole too coarsely (what counts as equal is too large)
// mistake 43: the three areas were held against the whole too coarsely (what counts as equal is too large)
// mistake 44: the three areas were held against the whole too coarsely (what counts as equal is too large)
// mistake 45: the three areas were held against the whole too coarsely (what counts as equal is too large)
// mistake 46: a place had to be outside of all three edges to miss
// mistake 47: all three edges were tested from a
// mistake 48: the test for a parallel ray was turned round
// mistake 49: t had the wrong sign
// mistake 50: v was computed with the other edge (both are from a to b)
// mistake 51: the answer was v
// mistake 52: a parallel ray met the triangle (no test for 0, and what is no number is the answer)
// mistake 53: the normal had length 1 above, but not below the line of t
// mistake 54: t was computed with the other edge
// The two-step way: the place in the plane, then on which side of each edge it lies.
// By areas: inside they sum to the whole.
float area(vec3 a, vec3 b, vec3 c) { return 0.5 * length(cross(b - a, c - a)); }
bool is_in_areas(vec3 place, vec3 a, vec3 b, vec3 c) {
  float off = abs(area(place, a, b) + area(place, b, c) + area(place, c, a) - area(a, b, c));
  return off < (MISTAKE == 40 ? 0.5 : MISTAKE == 41 ? 0.2 : MISTAKE == 42 ? 0.1 : MISTAKE == 43 ? 0.05 : MISTAKE == 44 ? 0.01 : 0.001);
}
float by_edges(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c) {
  vec3 normal = cross(b - a, c - a), n = MISTAKE == 35 ? cross(b, c) : normal;
  float slant = dot(n, direction);
  if (slant == 0.0) return -1.0;
  float t = dot(n, MISTAKE == 31 ? a : a - origin) / slant;
  if (MISTAKE == 53) t /= length(normal);
  if (MISTAKE == 36) t = abs(t);
  if (t < 0.0) return -1.0;
  vec3 place = origin + t * direction;
  if (MISTAKE == 32)
    return any(lessThan(place, min(a, min(b, c)))) || any(greaterThan(place, max(a, max(b, c)))) ? -1.0 : t;
  if (MISTAKE >= 40 && MISTAKE <= 45) return is_in_areas(place, a, b, c) ? t : -1.0;
  float of_ab = dot(n, cross(b - a, place - (MISTAKE == 25 ? c : a))), of_bc = dot(n, cross(c - b, place - (MISTAKE == 26 || MISTAKE == 47 ? a : b)));
  float of_ca = dot(n, cross(a - c, place - (MISTAKE == 27 ? b : MISTAKE == 47 ? a : c)));
  if (MISTAKE == 28) of_ab = -of_ab;
  if (MISTAKE == 29) of_bc = -of_bc;
  if (MISTAKE == 30) of_ca = -of_ca;
  if (MISTAKE == 46) return of_ab < 0.0 && of_bc < 0.0 && of_ca < 0.0 ? -1.0 : t;
  return of_ab < 0.0 || of_bc < 0.0 || of_ca < 0.0 ? -1.0 : t;
}

float ray_triangle(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c) {
  vec3 d = MISTAKE == 13 ? normalize(direction) : direction;
  vec3 to_b = MISTAKE == 18 ? b : b - a, to_c = MISTAKE == 18 ? c : MISTAKE == 37 ? c - b : c - a, from_a = MISTAKE == 38 ? a - origin : MISTAKE == 17 ? origin : origin - a;
  float none = MISTAKE == 22 ? 0.0 : MISTAKE == 34 ? 1e30 : -1.0;
#if MISTAKE >= 25 && MISTAKE <= 32 || MISTAKE == 35 || MISTAKE == 36 || MISTAKE >= 40 && MISTAKE <= 47 || MISTAKE == 53
  return by_edges(origin, direction, a, b, c);
#endif
  vec3 p = MISTAKE == 20 ? cross(to_c, d) : cross(d, to_c);
  float determinant = MISTAKE == 19 ? -dot(to_b, p) : dot(to_b, p);
  float zero = MISTAKE == 10 ? 1e-3 : 1e-9;
  if (MISTAKE == 11) zero = 0.1 * length(cross(to_b, to_c)) * length(d);
  if (MISTAKE == 48 && abs(determinant) > zero) return none;
  if (MISTAKE != 12 && MISTAKE != 52 && MISTAKE != 48 && abs(determinant) < zero) return none;
  if (MISTAKE == 8 && determinant < 0.0 || MISTAKE == 9 && determinant > 0.0) return none;
  vec3 q = cross(from_a, to_b);
  float u = dot(from_a, p), v = dot(d, q), t = dot(MISTAKE == 54 ? to_b : to_c, q);
  if (MISTAKE == 39) determinant = 1.0 / determinant;
  if (MISTAKE == 50) v = dot(d, cross(from_a, to_c));
  if (MISTAKE != 15) u /= determinant, v /= determinant;
  if (MISTAKE != 14) t /= determinant;
#if MISTAKE == 16
  p = cross(d, to_b), q = cross(from_a, to_c);
  u = dot(from_a, p) / determinant, v = dot(d, q) / determinant;
#endif
  bool inside = (u >= 0.0 || MISTAKE == 1) && (v >= 0.0 || MISTAKE == 2) && u + v <= 1.0;
  if (MISTAKE == 3) inside = u >= 0.0 && v >= 0.0 && u <= 1.0 && v <= 1.0;
  if (MISTAKE == 4) inside = u >= 0.0 && v >= 0.0;
  if (MISTAKE == 5) inside = true;
  if (MISTAKE == 49) t = -t;
  if (MISTAKE == 12 || MISTAKE == 52) inside = !(u < 0.0 || v < 0.0 || u + v > 1.0);
  if (MISTAKE == 23) inside = u <= 1.0 && v <= 1.0;
  if (MISTAKE == 24) inside = inside && u + v <= 0.5;
  if (MISTAKE == 33) inside = u >= 0.0 && v >= 0.0 && u + v <= 2.0;
  if (!inside) return none;
  if (MISTAKE == 21) return u;
  if (MISTAKE == 51) return v;
  if (MISTAKE == 52) return t < 0.0 ? none : t;
  if (MISTAKE == 7) return abs(t);
  if (MISTAKE == 12) return t < 0.0 ? none : t;
  return t >= 0.0 || MISTAKE == 6 ? t : none;
}
