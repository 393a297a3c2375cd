// Four floats at once, as the box test needs them. max and min return their second operand where the first is
// NaN: the slab test relies on it. SSE where there is one, plain loops elsewhere.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace gnomon::raytrace {

#if defined(__SSE2__)
struct Float4 {
  __m128 v;
  static Float4 load(const float* aligned) { return {_mm_load_ps(aligned)}; }
  static Float4 all(float x) { return {_mm_set1_ps(x)}; }
  static Float4 of(float x, float y, float z, float w) { return {_mm_setr_ps(x, y, z, w)}; }
  void store(float* aligned) const { _mm_store_ps(aligned, v); }
};
inline Float4 operator-(Float4 a, Float4 b) {
  return {_mm_sub_ps(a.v, b.v)};
}
inline Float4 operator+(Float4 a, Float4 b) {
  return {_mm_add_ps(a.v, b.v)};
}
inline Float4 operator*(Float4 a, Float4 b) {
  return {_mm_mul_ps(a.v, b.v)};
}
inline Float4 max_keep(Float4 a, Float4 kept) {
  return {_mm_max_ps(a.v, kept.v)};
}
inline Float4 min_keep(Float4 a, Float4 kept) {
  return {_mm_min_ps(a.v, kept.v)};
}
inline Float4 magnitude(Float4 a) {
  return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.v)};
}
/// Towards zero; each must fit.
inline void store_truncated(Float4 a, std::int32_t* aligned) {
  _mm_store_si128(reinterpret_cast<__m128i*>(aligned), _mm_cvttps_epi32(a.v));
}
/// Bit i: a[i] <= b[i].
inline int less_equal_mask(Float4 a, Float4 b) {
  return _mm_movemask_ps(_mm_cmple_ps(a.v, b.v));
}
/// Rows to columns.
inline void transpose(Float4 (&rows)[4]) {
  _MM_TRANSPOSE4_PS(rows[0].v, rows[1].v, rows[2].v, rows[3].v);
}
#else
struct Float4 {
  float v[4];
  static Float4 load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
  static Float4 all(float x) { return {{x, x, x, x}}; }
  static Float4 of(float x, float y, float z, float w) { return {{x, y, z, w}}; }
  void store(float* p) const {
    for (int i = 0; i < 4; ++i) p[i] = v[i];
  }
};
template <class F>
inline Float4 each(Float4 a, Float4 b, F f) {
  return {{f(a.v[0], b.v[0]), f(a.v[1], b.v[1]), f(a.v[2], b.v[2]), f(a.v[3], b.v[3])}};
}
inline Float4 operator-(Float4 a, Float4 b) {
  return each(a, b, [](float x, float y) { return x - y; });
}
inline Float4 operator+(Float4 a, Float4 b) {
  return each(a, b, [](float x, float y) { return x + y; });
}
inline Float4 operator*(Float4 a, Float4 b) {
  return each(a, b, [](float x, float y) { return x * y; });
}
inline Float4 max_keep(Float4 a, Float4 k) {
  return each(a, k, [](float x, float y) { return x > y ? x : y; });
}
inline Float4 min_keep(Float4 a, Float4 k) {
  return each(a, k, [](float x, float y) { return x < y ? x : y; });
}
inline Float4 magnitude(Float4 a) {
  return each(a, a, [](float x, float) { return std::fabs(x); });
}
inline void store_truncated(Float4 a, std::int32_t* out) {
  for (int i = 0; i < 4; ++i) out[i] = static_cast<std::int32_t>(a.v[i]);
}
inline int less_equal_mask(Float4 a, Float4 b) {
  int mask = 0;
  for (int i = 0; i < 4; ++i) mask |= (a.v[i] <= b.v[i] ? 1 : 0) << i;
  return mask;
}
inline void transpose(Float4 (&rows)[4]) {
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < i; ++k) std::swap(rows[i].v[k], rows[k].v[i]);
}
#endif

}  // namespace gnomon::raytrace
