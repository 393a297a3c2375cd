// Exact numbers: m * 2^e with m an integer of any size (GMP). Every double is one, and sums, differences and
// products of them are too, so that the sign of a polynomial of doubles is certain. No division, no rounding.
#pragma once

#include <gmpxx.h>

#include <array>

#include "scene/math.h"

namespace gnomon::raytrace {

class Dyadic {
 public:
  Dyadic() = default;
  /// A finite double.
  explicit Dyadic(double value) {
    if (value == 0.0) return;
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    mantissa_ = std::ldexp(mantissa, 53);
    exponent_ = exponent - 53;
  }

  int sign() const { return sgn(mantissa_); }

  /// a / b to a few roundings, also where neither is in the range of doubles; b is not zero.
  friend double quotient(const Dyadic& a, const Dyadic& b) {
    long a_exponent = 0, b_exponent = 0;
    const double over = mpz_get_d_2exp(&a_exponent, a.mantissa_.get_mpz_t());
    const double under = mpz_get_d_2exp(&b_exponent, b.mantissa_.get_mpz_t());
    const long exponent = a_exponent + a.exponent_ - b_exponent - b.exponent_;
    return std::ldexp(over / under, static_cast<int>(std::clamp(exponent, -4000L, 4000L)));
  }

  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    Dyadic r;
    r.mantissa_ = a.mantissa_ * b.mantissa_;
    r.exponent_ = a.exponent_ + b.exponent_;
    return r;
  }
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return a.plus(b, 1); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a.plus(b, -1); }

 private:
  Dyadic plus(const Dyadic& b, int sign_of_b) const {
    if (b.sign() == 0) return *this;
    Dyadic r;
    if (sign() == 0) {
      r.mantissa_ = sign_of_b * b.mantissa_;
      r.exponent_ = b.exponent_;
      return r;
    }
    r.exponent_ = std::min(exponent_, b.exponent_);
    r.mantissa_ = mantissa_ << static_cast<mp_bitcnt_t>(exponent_ - r.exponent_);
    const mpz_class other = b.mantissa_ << static_cast<mp_bitcnt_t>(b.exponent_ - r.exponent_);
    if (sign_of_b > 0)
      r.mantissa_ += other;
    else
      r.mantissa_ -= other;
    return r;
  }

  mpz_class mantissa_ = 0;
  long exponent_ = 0;
};

struct Dyadic3 {
  Dyadic x, y, z;
  Dyadic3() = default;
  explicit Dyadic3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
  Dyadic3(Dyadic a, Dyadic b, Dyadic c) : x(std::move(a)), y(std::move(b)), z(std::move(c)) {}
};
inline Dyadic3 operator+(const Dyadic3& a, const Dyadic3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Dyadic3 operator-(const Dyadic3& a, const Dyadic3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Dyadic3 operator*(const Dyadic& s, const Dyadic3& v) {
  return {s * v.x, s * v.y, s * v.z};
}
inline Dyadic dot(const Dyadic3& a, const Dyadic3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Dyadic3 cross(const Dyadic3& a, const Dyadic3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace gnomon::raytrace
