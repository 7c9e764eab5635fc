/// A register of AVX-512 with the operations that the sweep needs. Included by sweep_width8.cc
/// only.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace fingertip::lattice::springs {

struct Pack8d {
  using Real = double;
  using Mask = __mmask8;
  static constexpr int width = 8;
  static constexpr bool estimates_roots = true;
  static constexpr int root_terms = 4;
  __m512d v;

  static Pack8d load(const double* from) { return {_mm512_load_pd(from)}; }
  static Pack8d all(double value) { return {_mm512_set1_pd(value)}; }
  void store(double* to) const { _mm512_store_pd(to, v); }

  friend Pack8d operator+(Pack8d a, Pack8d b) { return {_mm512_add_pd(a.v, b.v)}; }
  friend Pack8d operator-(Pack8d a, Pack8d b) { return {_mm512_sub_pd(a.v, b.v)}; }
  friend Pack8d operator*(Pack8d a, Pack8d b) { return {_mm512_mul_pd(a.v, b.v)}; }
  friend Pack8d multiply_add(Pack8d a, Pack8d b, Pack8d c) {
    return {_mm512_fmadd_pd(a.v, b.v, c.v)};
  }
  friend Pack8d multiply_subtract(Pack8d a, Pack8d b, Pack8d c) {
    return {_mm512_fmsub_pd(a.v, b.v, c.v)};
  }
  friend Pack8d subtract_product(Pack8d c, Pack8d a, Pack8d b) {
    return {_mm512_fnmadd_pd(a.v, b.v, c.v)};
  }
  friend Pack8d maximum(Pack8d a, Pack8d b) { return {_mm512_max_pd(a.v, b.v)}; }

  static Mask mask(const std::uint8_t* bits) { return *bits; }
  friend Mask greater(Pack8d a, Pack8d b) { return _mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ); }
  static bool any(Mask m) { return m != 0; }
  friend Pack8d where(Mask m, Pack8d a) { return {_mm512_maskz_mov_pd(m, a.v)}; }
  friend Pack8d multiply_add_where(Mask m, Pack8d a, Pack8d b, Pack8d c) {
    return {_mm512_maskz_fmadd_pd(m, a.v, b.v, c.v)};
  }
  friend Pack8d select(Mask m, Pack8d yes, Pack8d no) {
    return {_mm512_mask_blend_pd(m, no.v, yes.v)};
  }

  friend Pack8d root_estimate(Pack8d a) { return {_mm512_rsqrt14_pd(a.v)}; }

  friend Pack8d next_lane(Pack8d a) {
    return {_mm512_permutexvar_pd(_mm512_set_epi64(0, 7, 6, 5, 4, 3, 2, 1), a.v)};
  }
  friend Pack8d previous_lane(Pack8d a) {
    return {_mm512_permutexvar_pd(_mm512_set_epi64(6, 5, 4, 3, 2, 1, 0, 7), a.v)};
  }
  friend void keep(Pack8d& a) { asm volatile("" : "+v"(a.v)); }
};

struct Pack16f {
  using Real = float;
  using Mask = __mmask16;
  static constexpr int width = 16;
  static constexpr bool estimates_roots = true;
  static constexpr int root_terms = 2;
  __m512 v;

  static Pack16f load(const float* from) { return {_mm512_load_ps(from)}; }
  static Pack16f all(float value) { return {_mm512_set1_ps(value)}; }
  void store(float* to) const { _mm512_store_ps(to, v); }

  friend Pack16f operator+(Pack16f a, Pack16f b) { return {_mm512_add_ps(a.v, b.v)}; }
  friend Pack16f operator-(Pack16f a, Pack16f b) { return {_mm512_sub_ps(a.v, b.v)}; }
  friend Pack16f operator*(Pack16f a, Pack16f b) { return {_mm512_mul_ps(a.v, b.v)}; }
  friend Pack16f multiply_add(Pack16f a, Pack16f b, Pack16f c) {
    return {_mm512_fmadd_ps(a.v, b.v, c.v)};
  }
  friend Pack16f multiply_subtract(Pack16f a, Pack16f b, Pack16f c) {
    return {_mm512_fmsub_ps(a.v, b.v, c.v)};
  }
  friend Pack16f subtract_product(Pack16f c, Pack16f a, Pack16f b) {
    return {_mm512_fnmadd_ps(a.v, b.v, c.v)};
  }
  friend Pack16f maximum(Pack16f a, Pack16f b) { return {_mm512_max_ps(a.v, b.v)}; }

  static Mask mask(const std::uint16_t* bits) { return *bits; }
  friend Mask greater(Pack16f a, Pack16f b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_GT_OQ); }
  static bool any(Mask m) { return m != 0; }
  friend Pack16f where(Mask m, Pack16f a) { return {_mm512_maskz_mov_ps(m, a.v)}; }
  friend Pack16f multiply_add_where(Mask m, Pack16f a, Pack16f b, Pack16f c) {
    return {_mm512_maskz_fmadd_ps(m, a.v, b.v, c.v)};
  }
  friend Pack16f select(Mask m, Pack16f yes, Pack16f no) {
    return {_mm512_mask_blend_ps(m, no.v, yes.v)};
  }

  friend Pack16f root_estimate(Pack16f a) { return {_mm512_rsqrt14_ps(a.v)}; }

  friend Pack16f next_lane(Pack16f a) {
    return {_mm512_permutexvar_ps(
        _mm512_set_epi32(0, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1), a.v)};
  }
  friend Pack16f previous_lane(Pack16f a) {
    return {_mm512_permutexvar_ps(
        _mm512_set_epi32(14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 15), a.v)};
  }
  friend void keep(Pack16f& a) { asm volatile("" : "+v"(a.v)); }
};

}  // namespace fingertip::lattice::springs
