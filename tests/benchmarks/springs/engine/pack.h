/// A register with the operations that the sweep needs. Included by sweep_widths.cc only.
#pragma once

#include <experimental/simd>
#include <type_traits>
#include <utility>

#include <immintrin.h>

#include "tests/benchmarks/springs/engine/sweep.h"

namespace fingertip::lattice::springs {

// What std::experimental::simd lacks: its fma is a call. Without an instruction, two roundings.
#if defined(__AVX512F__)
[[gnu::always_inline]] inline __m512d fused_add(__m512d a, __m512d b, __m512d c) {
  return _mm512_fmadd_pd(a, b, c);
}
[[gnu::always_inline]] inline __m512 fused_add(__m512 a, __m512 b, __m512 c) {
  return _mm512_fmadd_ps(a, b, c);
}
[[gnu::always_inline]] inline __m512d fused_subtract(__m512d a, __m512d b, __m512d c) {
  return _mm512_fmsub_pd(a, b, c);
}
[[gnu::always_inline]] inline __m512 fused_subtract(__m512 a, __m512 b, __m512 c) {
  return _mm512_fmsub_ps(a, b, c);
}
[[gnu::always_inline]] inline __m512d subtract_fused(__m512d c, __m512d a, __m512d b) {
  return _mm512_fnmadd_pd(a, b, c);
}
[[gnu::always_inline]] inline __m512 subtract_fused(__m512 c, __m512 a, __m512 b) {
  return _mm512_fnmadd_ps(a, b, c);
}
/// 1/√a to 14 bits.
[[gnu::always_inline]] inline __m512d root_to_14_bits(__m512d a) {
  return _mm512_rsqrt14_pd(a);
}
[[gnu::always_inline]] inline __m512 root_to_14_bits(__m512 a) {
  return _mm512_rsqrt14_ps(a);
}
#elif defined(__FMA__)
[[gnu::always_inline]] inline __m256d fused_add(__m256d a, __m256d b, __m256d c) {
  return _mm256_fmadd_pd(a, b, c);
}
[[gnu::always_inline]] inline __m256 fused_add(__m256 a, __m256 b, __m256 c) {
  return _mm256_fmadd_ps(a, b, c);
}
[[gnu::always_inline]] inline __m256d fused_subtract(__m256d a, __m256d b, __m256d c) {
  return _mm256_fmsub_pd(a, b, c);
}
[[gnu::always_inline]] inline __m256 fused_subtract(__m256 a, __m256 b, __m256 c) {
  return _mm256_fmsub_ps(a, b, c);
}
[[gnu::always_inline]] inline __m256d subtract_fused(__m256d c, __m256d a, __m256d b) {
  return _mm256_fnmadd_pd(a, b, c);
}
[[gnu::always_inline]] inline __m256 subtract_fused(__m256 c, __m256 a, __m256 b) {
  return _mm256_fnmadd_ps(a, b, c);
}
#else
template <typename Raw>
[[gnu::always_inline]] inline Raw fused_add(Raw a, Raw b, Raw c) {
  return a * b + c;
}
template <typename Raw>
[[gnu::always_inline]] inline Raw fused_subtract(Raw a, Raw b, Raw c) {
  return a * b - c;
}
template <typename Raw>
[[gnu::always_inline]] inline Raw subtract_fused(Raw c, Raw a, Raw b) {
  return c - a * b;
}
#endif

/// `Simd` is a native std::experimental::simd: another type for every instruction set, which keeps
/// the instantiations of the sweep apart. Inlined by force.
template <typename Simd>
struct Pack {
  using Real = typename Simd::value_type;
  using Mask = typename Simd::mask_type;
  using Raw [[gnu::vector_size(sizeof(Simd))]] = Real;
  static constexpr int width = int(Simd::size());
  static constexpr bool estimates_roots = sizeof(Simd) == 64;  // AVX-512
  static constexpr int root_terms = std::is_same_v<Real, double> ? 4 : 2;
  Simd v;

  [[gnu::always_inline]] static Pack load(const Real* from) {
    return {Simd(from, std::experimental::vector_aligned)};
  }
  [[gnu::always_inline]] static Pack all(Real value) { return {Simd(value)}; }
  [[gnu::always_inline]] void store(Real* to) const {
    v.copy_to(to, std::experimental::vector_aligned);
  }

  [[gnu::always_inline]] friend Pack operator+(Pack a, Pack b) { return {a.v + b.v}; }
  [[gnu::always_inline]] friend Pack operator-(Pack a, Pack b) { return {a.v - b.v}; }
  [[gnu::always_inline]] friend Pack operator*(Pack a, Pack b) { return {a.v * b.v}; }
  [[gnu::always_inline]] friend Pack operator/(Pack a, Pack b) { return {a.v / b.v}; }
  [[gnu::always_inline]] friend Pack square_root(Pack a) { return {sqrt(a.v)}; }
  [[gnu::always_inline]] friend Pack maximum(Pack a, Pack b) { return {max(a.v, b.v)}; }

  [[gnu::always_inline]] friend Pack multiply_add(Pack a, Pack b, Pack c) {
    return {Simd(fused_add(Raw(a.v), Raw(b.v), Raw(c.v)))};
  }
  [[gnu::always_inline]] friend Pack multiply_subtract(Pack a, Pack b, Pack c) {
    return {Simd(fused_subtract(Raw(a.v), Raw(b.v), Raw(c.v)))};
  }
  [[gnu::always_inline]] friend Pack subtract_product(Pack c, Pack a, Pack b) {
    return {Simd(subtract_fused(Raw(c.v), Raw(a.v), Raw(b.v)))};
  }

  [[gnu::always_inline]] static Mask mask(const LaneMask<Real>* bits) {
    return Mask::__from_bitset(*bits);
  }
  [[gnu::always_inline]] friend Mask greater(Pack a, Pack b) { return a.v > b.v; }
  [[gnu::always_inline]] static bool any(Mask m) { return any_of(m); }
  [[gnu::always_inline]] friend Pack select(Mask m, Pack yes, Pack no) {
    where(m, no.v) = yes.v;
    return no;
  }
  [[gnu::always_inline]] friend Pack where(Mask m, Pack a) { return select(m, a, all(0)); }
  [[gnu::always_inline]] friend Pack multiply_add_where(Mask m, Pack a, Pack b, Pack c) {
    return where(m, multiply_add(a, b, c));
  }

  /// Where estimates_roots.
  [[gnu::always_inline]] friend Pack root_estimate(Pack a) {
    return {Simd(root_to_14_bits(Raw(a.v)))};
  }

  [[gnu::always_inline]] friend Pack next_lane(Pack a) { return rotated<1>(a, Lanes()); }
  [[gnu::always_inline]] friend Pack previous_lane(Pack a) {
    return rotated<width - 1>(a, Lanes());
  }

  /// Keeps the compiler from moving what makes `a` behind what follows.
  [[gnu::always_inline]] friend void keep(Pack& a) {
    Raw raw = static_cast<Raw>(a.v);
    asm volatile("" : "+v"(raw));
    a.v = Simd(raw);
  }

 private:
  using Lanes = std::make_integer_sequence<int, width>;
  template <int by, int... Lane>
  [[gnu::always_inline]] static Pack rotated(Pack a, std::integer_sequence<int, Lane...>) {
    const Raw raw = static_cast<Raw>(a.v);
    return {Simd(__builtin_shufflevector(raw, raw, (Lane + by) % width...))};
  }
};

}  // namespace fingertip::lattice::springs
