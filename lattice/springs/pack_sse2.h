/// A register of SSE2, which every x86-64 has, with the operations that the sweep needs. Included
/// by sweep_width2.cc only.
#pragma once

#include <emmintrin.h>

#include <cstdint>

namespace fingertip::lattice::springs {

struct Pack2d {
  using Real = double;
  struct Mask {
    __m128d m;
  };
  static constexpr int width = 2;
  static constexpr bool estimates_roots = false;
  __m128d v;

  static Pack2d load(const double* from) { return {_mm_load_pd(from)}; }
  static Pack2d all(double value) { return {_mm_set1_pd(value)}; }
  void store(double* to) const { _mm_store_pd(to, v); }

  friend Pack2d operator+(Pack2d a, Pack2d b) { return {_mm_add_pd(a.v, b.v)}; }
  friend Pack2d operator-(Pack2d a, Pack2d b) { return {_mm_sub_pd(a.v, b.v)}; }
  friend Pack2d operator*(Pack2d a, Pack2d b) { return {_mm_mul_pd(a.v, b.v)}; }
  friend Pack2d operator/(Pack2d a, Pack2d b) { return {_mm_div_pd(a.v, b.v)}; }
  friend Pack2d square_root(Pack2d a) { return {_mm_sqrt_pd(a.v)}; }
  friend Pack2d multiply_add(Pack2d a, Pack2d b, Pack2d c) { return a * b + c; }
  friend Pack2d multiply_subtract(Pack2d a, Pack2d b, Pack2d c) { return a * b - c; }
  friend Pack2d subtract_product(Pack2d c, Pack2d a, Pack2d b) { return c - a * b; }
  friend Pack2d maximum(Pack2d a, Pack2d b) { return {_mm_max_pd(a.v, b.v)}; }

  static Mask mask(const std::uint8_t* bits) {
    const __m128i lane = _mm_set_epi32(2, 2, 1, 1);
    const __m128i set = _mm_and_si128(_mm_set1_epi32(*bits), lane);
    return {_mm_castsi128_pd(_mm_cmpeq_epi32(set, lane))};
  }
  friend Mask greater(Pack2d a, Pack2d b) { return {_mm_cmpgt_pd(a.v, b.v)}; }
  static bool any(Mask m) { return _mm_movemask_pd(m.m) != 0; }
  friend Pack2d where(Mask m, Pack2d a) { return {_mm_and_pd(m.m, a.v)}; }
  friend Pack2d multiply_add_where(Mask m, Pack2d a, Pack2d b, Pack2d c) {
    return where(m, multiply_add(a, b, c));
  }
  friend Pack2d select(Mask m, Pack2d yes, Pack2d no) {
    return {_mm_or_pd(_mm_and_pd(m.m, yes.v), _mm_andnot_pd(m.m, no.v))};
  }

  friend Pack2d next_lane(Pack2d a) { return {_mm_shuffle_pd(a.v, a.v, 1)}; }
  friend Pack2d previous_lane(Pack2d a) { return {_mm_shuffle_pd(a.v, a.v, 1)}; }
  friend void keep(Pack2d& a) { asm volatile("" : "+x"(a.v)); }
};

struct Pack4f {
  using Real = float;
  struct Mask {
    __m128 m;
  };
  static constexpr int width = 4;
  static constexpr bool estimates_roots = false;
  __m128 v;

  static Pack4f load(const float* from) { return {_mm_load_ps(from)}; }
  static Pack4f all(float value) { return {_mm_set1_ps(value)}; }
  void store(float* to) const { _mm_store_ps(to, v); }

  friend Pack4f operator+(Pack4f a, Pack4f b) { return {_mm_add_ps(a.v, b.v)}; }
  friend Pack4f operator-(Pack4f a, Pack4f b) { return {_mm_sub_ps(a.v, b.v)}; }
  friend Pack4f operator*(Pack4f a, Pack4f b) { return {_mm_mul_ps(a.v, b.v)}; }
  friend Pack4f operator/(Pack4f a, Pack4f b) { return {_mm_div_ps(a.v, b.v)}; }
  friend Pack4f square_root(Pack4f a) { return {_mm_sqrt_ps(a.v)}; }
  friend Pack4f multiply_add(Pack4f a, Pack4f b, Pack4f c) { return a * b + c; }
  friend Pack4f multiply_subtract(Pack4f a, Pack4f b, Pack4f c) { return a * b - c; }
  friend Pack4f subtract_product(Pack4f c, Pack4f a, Pack4f b) { return c - a * b; }
  friend Pack4f maximum(Pack4f a, Pack4f b) { return {_mm_max_ps(a.v, b.v)}; }

  static Mask mask(const std::uint16_t* bits) {
    const __m128i lane = _mm_set_epi32(8, 4, 2, 1);
    const __m128i set = _mm_and_si128(_mm_set1_epi32(*bits), lane);
    return {_mm_castsi128_ps(_mm_cmpeq_epi32(set, lane))};
  }
  friend Mask greater(Pack4f a, Pack4f b) { return {_mm_cmpgt_ps(a.v, b.v)}; }
  static bool any(Mask m) { return _mm_movemask_ps(m.m) != 0; }
  friend Pack4f where(Mask m, Pack4f a) { return {_mm_and_ps(m.m, a.v)}; }
  friend Pack4f multiply_add_where(Mask m, Pack4f a, Pack4f b, Pack4f c) {
    return where(m, multiply_add(a, b, c));
  }
  friend Pack4f select(Mask m, Pack4f yes, Pack4f no) {
    return {_mm_or_ps(_mm_and_ps(m.m, yes.v), _mm_andnot_ps(m.m, no.v))};
  }

  friend Pack4f next_lane(Pack4f a) { return {_mm_shuffle_ps(a.v, a.v, 0b00'11'10'01)}; }
  friend Pack4f previous_lane(Pack4f a) { return {_mm_shuffle_ps(a.v, a.v, 0b10'01'00'11)}; }
  friend void keep(Pack4f& a) { asm volatile("" : "+x"(a.v)); }
};

}  // namespace fingertip::lattice::springs
