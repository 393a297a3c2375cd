// mpz_class as raytrace/precision/dyadic.h uses it, over mini-gmp, which GMP's authors write in plain C: results are GMP's.
#pragma once

#include <mini-gmp.h>

#include <cmath>
#include <utility>

class mpz_class {
 public:
  mpz_class() { mpz_init(value_); }
  mpz_class(int value) { mpz_init_set_si(value_, value); }
  mpz_class(const mpz_class& other) { mpz_init_set(value_, other.value_); }
  mpz_class(mpz_class&& other) noexcept : mpz_class() { mpz_swap(value_, other.value_); }
  mpz_class& operator=(mpz_class other) noexcept {
    mpz_swap(value_, other.value_);
    return *this;
  }
  mpz_class& operator=(double value) {  // towards zero
    mpz_set_d(value_, value);
    return *this;
  }
  mpz_class& operator=(int value) {
    mpz_set_si(value_, value);
    return *this;
  }
  ~mpz_class() { mpz_clear(value_); }

  friend int sgn(const mpz_class& a) { return mpz_sgn(a.value_); }
  friend mpz_class operator*(const mpz_class& a, const mpz_class& b) {
    mpz_class product;
    mpz_mul(product.value_, a.value_, b.value_);
    return product;
  }
  friend mpz_class operator<<(const mpz_class& a, mp_bitcnt_t bits) {
    mpz_class shifted;
    mpz_mul_2exp(shifted.value_, a.value_, bits);
    return shifted;
  }
  mpz_class& operator+=(const mpz_class& b) {
    mpz_add(value_, value_, b.value_);
    return *this;
  }
  mpz_class& operator-=(const mpz_class& b) {
    mpz_sub(value_, value_, b.value_);
    return *this;
  }
  mpz_srcptr get_mpz_t() const { return value_; }

 private:
  mpz_t value_;
};

/// Returns d in ±[1/2, 1), the value's first 53 bits, and the exponent with value = d * 2^exponent; both 0 of zero. mini-gmp
/// lacks this function.
inline double mpz_get_d_2exp(long* exponent, mpz_srcptr value) {
  const std::size_t bits = mpz_sgn(value) == 0 ? 0 : mpz_sizeinbase(value, 2);
  *exponent = static_cast<long>(bits);
  if (bits == 0) return 0.0;
  constexpr std::size_t digits = 53;
  const std::size_t dropped = bits > digits ? bits - digits : 0;
  mpz_t top;
  mpz_init(top);
  mpz_tdiv_q_2exp(top, value, dropped);
  const double first = std::ldexp(mpz_get_d(top), -static_cast<int>(bits - dropped));
  mpz_clear(top);
  return first;
}
