// Bounds of a solid's function and of its slope over a stretch of a ray in the solid's frame, for all origins within `error`
// of o. Permutations TORUS and IMPLICIT; needs bounds.glsl, world.glsl and the functions' slopes.

Slope solid_slope(ShapeData s, vec3 o, vec3 d, vec2 range, float error) {
  ambiguous = false;
  nothing = false;
  Slope x = Slope(i_add(vec2(o.x - error, o.x + error), i_mul(range, vec2(d.x))), vec2(d.x));
  Slope y = Slope(i_add(vec2(o.y - error, o.y + error), i_mul(range, vec2(d.y))), vec2(d.y));
  Slope z = Slope(i_add(vec2(o.z - error, o.z + error), i_mul(range, vec2(d.z))), vec2(d.z));
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
