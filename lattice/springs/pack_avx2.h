/// A register of AVX2 with FMA with the operations that the sweep needs. Included by
/// sweep_width4.cc only.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace fingertip::lattice::springs {

struct Pack4d {
  using Real = double;
  struct Mask {
    __m256d m;
  };
  static constexpr int width = 4;
  static constexpr bool estimates_roots = false;
  __m256d v;

  static Pack4d load(const double* from) { return {_mm256_load_pd(from)}; }
  static Pack4d all(double value) { return {_mm256_set1_pd(value)}; }
  void store(double* to) const { _mm256_store_pd(to, v); }

  friend Pack4d operator+(Pack4d a, Pack4d b) { return {_mm256_add_pd(a.v, b.v)}; }
  friend Pack4d operator-(Pack4d a, Pack4d b) { return {_mm256_sub_pd(a.v, b.v)}; }
  friend Pack4d operator*(Pack4d a, Pack4d b) { return {_mm256_mul_pd(a.v, b.v)}; }
  friend Pack4d operator/(Pack4d a, Pack4d b) { return {_mm256_div_pd(a.v, b.v)}; }
  friend Pack4d square_root(Pack4d a) { return {_mm256_sqrt_pd(a.v)}; }
  friend Pack4d multiply_add(Pack4d a, Pack4d b, Pack4d c) {
    return {_mm256_fmadd_pd(a.v, b.v, c.v)};
  }
  friend Pack4d multiply_subtract(Pack4d a, Pack4d b, Pack4d c) {
    return {_mm256_fmsub_pd(a.v, b.v, c.v)};
  }
  friend Pack4d subtract_product(Pack4d c, Pack4d a, Pack4d b) {
    return {_mm256_fnmadd_pd(a.v, b.v, c.v)};
  }
  friend Pack4d maximum(Pack4d a, Pack4d b) { return {_mm256_max_pd(a.v, b.v)}; }

  static Mask mask(const std::uint8_t* bits) {
    const __m256i lane = _mm256_set_epi64x(8, 4, 2, 1);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi64x(*bits), lane);
    return {_mm256_castsi256_pd(_mm256_cmpeq_epi64(set, lane))};
  }
  friend Mask greater(Pack4d a, Pack4d b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)}; }
  static bool any(Mask m) { return _mm256_movemask_pd(m.m) != 0; }
  friend Pack4d where(Mask m, Pack4d a) { return {_mm256_and_pd(m.m, a.v)}; }
  friend Pack4d multiply_add_where(Mask m, Pack4d a, Pack4d b, Pack4d c) {
    return where(m, multiply_add(a, b, c));
  }
  friend Pack4d select(Mask m, Pack4d yes, Pack4d no) {
    return {_mm256_blendv_pd(no.v, yes.v, m.m)};
  }

  friend Pack4d next_lane(Pack4d a) { return {_mm256_permute4x64_pd(a.v, 0b00'11'10'01)}; }
  friend Pack4d previous_lane(Pack4d a) { return {_mm256_permute4x64_pd(a.v, 0b10'01'00'11)}; }
  friend void keep(Pack4d& a) { asm volatile("" : "+x"(a.v)); }
};

struct Pack8f {
  using Real = float;
  struct Mask {
    __m256 m;
  };
  static constexpr int width = 8;
  static constexpr bool estimates_roots = false;
  __m256 v;

  static Pack8f load(const float* from) { return {_mm256_load_ps(from)}; }
  static Pack8f all(float value) { return {_mm256_set1_ps(value)}; }
  void store(float* to) const { _mm256_store_ps(to, v); }

  friend Pack8f operator+(Pack8f a, Pack8f b) { return {_mm256_add_ps(a.v, b.v)}; }
  friend Pack8f operator-(Pack8f a, Pack8f b) { return {_mm256_sub_ps(a.v, b.v)}; }
  friend Pack8f operator*(Pack8f a, Pack8f b) { return {_mm256_mul_ps(a.v, b.v)}; }
  friend Pack8f operator/(Pack8f a, Pack8f b) { return {_mm256_div_ps(a.v, b.v)}; }
  friend Pack8f square_root(Pack8f a) { return {_mm256_sqrt_ps(a.v)}; }
  friend Pack8f multiply_add(Pack8f a, Pack8f b, Pack8f c) {
    return {_mm256_fmadd_ps(a.v, b.v, c.v)};
  }
  friend Pack8f multiply_subtract(Pack8f a, Pack8f b, Pack8f c) {
    return {_mm256_fmsub_ps(a.v, b.v, c.v)};
  }
  friend Pack8f subtract_product(Pack8f c, Pack8f a, Pack8f b) {
    return {_mm256_fnmadd_ps(a.v, b.v, c.v)};
  }
  friend Pack8f maximum(Pack8f a, Pack8f b) { return {_mm256_max_ps(a.v, b.v)}; }

  static Mask mask(const std::uint16_t* bits) {
    const __m256i lane = _mm256_set_epi32(128, 64, 32, 16, 8, 4, 2, 1);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi32(*bits), lane);
    return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(set, lane))};
  }
  friend Mask greater(Pack8f a, Pack8f b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)}; }
  static bool any(Mask m) { return _mm256_movemask_ps(m.m) != 0; }
  friend Pack8f where(Mask m, Pack8f a) { return {_mm256_and_ps(m.m, a.v)}; }
  friend Pack8f multiply_add_where(Mask m, Pack8f a, Pack8f b, Pack8f c) {
    return where(m, multiply_add(a, b, c));
  }
  friend Pack8f select(Mask m, Pack8f yes, Pack8f no) {
    return {_mm256_blendv_ps(no.v, yes.v, m.m)};
  }

  friend Pack8f next_lane(Pack8f a) {
    return {_mm256_permutevar8x32_ps(a.v, _mm256_set_epi32(0, 7, 6, 5, 4, 3, 2, 1))};
  }
  friend Pack8f previous_lane(Pack8f a) {
    return {_mm256_permutevar8x32_ps(a.v, _mm256_set_epi32(6, 5, 4, 3, 2, 1, 0, 7))};
  }
  friend void keep(Pack8f& a) { asm volatile("" : "+x"(a.v)); }
};

}  // namespace fingertip::lattice::springs
