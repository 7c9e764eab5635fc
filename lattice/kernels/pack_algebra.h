/// Vectors and matrices whose entries are packs of doubles, or plain doubles.
#pragma once

#include <cmath>
#include <experimental/simd>
#include <type_traits>
#include <utility>

#include "lattice/kernels/packs.h"

namespace fingertip::lattice::inline kernels::kernel {

/// Calls `visit` with 0, 1, 2 as constants.
template <typename Visit>
[[gnu::always_inline]] inline void for_components(const Visit& visit) {
  visit(std::integral_constant<int, 0>());
  visit(std::integral_constant<int, 1>());
  visit(std::integral_constant<int, 2>());
}
/// Member x, y or z.
template <int K, typename Three>
[[gnu::always_inline]] inline auto& entry(Three& three) {
  if constexpr (K == 0) {
    return three.x;
  } else if constexpr (K == 1) {
    return three.y;
  } else {
    return three.z;
  }
}

template <typename Pack>
struct PackAlgebra {
  using Vector = PackVector<Pack>;
  /// A matrix by rows.
  struct Rows {
    Vector x, y, z;
  };

  /// The last lane of `before`, then the lanes of `value` but for its last.
  [[gnu::always_inline]] static Pack shifted(const Pack& before, const Pack& value) {
    return shifted(before, value, std::make_integer_sequence<int, int(Pack::size())>());
  }
  template <int... Lane>
  [[gnu::always_inline]] static Pack shifted(const Pack& before, const Pack& value,
                                             std::integer_sequence<int, Lane...>) {
    constexpr int last = int(Pack::size()) - 1;
    return Pack(__builtin_shufflevector(raw_vector(before), raw_vector(value), (last + Lane)...));
  }

  [[gnu::always_inline]] static Rows multiple(const Pack& s, const Rows& A) {
    return {s * A.x, s * A.y, s * A.z};
  }
  /// A:C.
  [[gnu::always_inline]] static Pack contract(const Rows& A, const Rows& C) {
    return dot(A.x, C.x) + dot(A.y, C.y) + dot(A.z, C.z);
  }
  /// A v.
  [[gnu::always_inline]] static Vector times(const Rows& A, const Vector& v) {
    return {dot(A.x, v), dot(A.y, v), dot(A.z, v)};
  }
  /// Aᵀ v.
  [[gnu::always_inline]] static Vector transposed_times(const Rows& A, const Vector& v) {
    return v.x * A.x + v.y * A.y + v.z * A.z;
  }
  [[gnu::always_inline]] static Rows plus_one(Rows H) {
    H.x.x += Pack(1.0);
    H.y.y += Pack(1.0);
    H.z.z += Pack(1.0);
    return H;
  }
  /// det(F) F⁻ᵀ.
  [[gnu::always_inline]] static Rows cofactor(const Rows& F) {
    return {cross(F.y, F.z), cross(F.z, F.x), cross(F.x, F.y)};
  }
  /// At least the largest eigenvalue of AᵀA (Gershgorin): its largest sum of a row's magnitudes.
  [[gnu::always_inline]] static Pack gershgorin(const Rows& A) {
    const auto product = [&](const Vector& r) __attribute__((always_inline)) {
      return Vector{r.y * r.z, r.z * r.x, r.x * r.y};
    };
    const auto square = [&](const Vector& r) __attribute__((always_inline)) {
      return Vector{r.x * r.x, r.y * r.y, r.z * r.z};
    };
    const Vector p = product(A.x) + product(A.y) + product(A.z),
                 s = square(A.x) + square(A.y) + square(A.z);
    const Pack yz = abs(p.x), zx = abs(p.y), xy = abs(p.z);
    return max(max(s.x + (xy + zx), s.y + (xy + yz)), s.z + (yz + zx));
  }

  /// e^x, |x| < 700. Packs: to 2 ulp, the same bits whatever the width.
  [[gnu::always_inline]] static Pack exp(const Pack& x) {
    if constexpr (std::is_floating_point_v<Pack>) {
      return std::exp(x);
    } else {
      return exp_of_pack(x);
    }
  }
  /// x = k ln 2 + r, |r| <= ln(2)/2; Taylor's series of e^r to the 13th power leaves 4e-18. Adding
  /// 1.5 2⁵² puts k into the last bits, from where it is moved to the exponent.
  static Pack exp_of_pack(const Pack& value) { return power_of_e(value).all; }
  /// e^x, and e^x - 1, sharp near 0.
  [[gnu::always_inline]] static std::pair<Pack, Pack> exponential(const Pack& value) {
    if constexpr (std::is_floating_point_v<Pack>) {
      return {std::exp(value), std::expm1(value)};
    } else {
      const auto [all, more, whole] = power_of_e(value);
      Pack less = all - Pack(1.0);
      where(whole == Pack(0.0), less) = more;
      return {all, less};
    }
  }
  [[gnu::always_inline]] static Pack expm1(const Pack& value) { return exponential(value).second; }
  struct PowerOfE {
    Pack all, more, whole;  ///< e^x, e^r - 1, k
  };
  static PowerOfE power_of_e(const Pack& value) {
    using Raw [[gnu::vector_size(sizeof(Pack))]] = double;
    using Bits [[gnu::vector_size(sizeof(Pack))]] = long long;
    constexpr double ln2_high = 0x1.62e42fefa38p-1, ln2_low = 0x1.ef35793c7673p-45;
    constexpr double shift = 0x1.8p52, inverse = 1.4426950408889634;
    const Pack x = min(max(value, Pack(-700.0)), Pack(700.0));
    const Pack sum = x * Pack(inverse) + Pack(shift), k = sum - Pack(shift);
    const Pack r = (x - k * Pack(ln2_high)) - k * Pack(ln2_low);
    Pack tail = 1.0;
    for (int n = 13; n > 1; --n) tail = Pack(1.0) + r * Pack(1.0 / n) * tail;
    const Pack more = r * tail, series = Pack(1.0) + more;
    const Bits power = reinterpret_cast<Bits>(raw_vector(sum)) << 52;
    return {Pack(reinterpret_cast<Raw>(reinterpret_cast<Bits>(raw_vector(series)) + power)), more,
            k};
  }

  /// Natural logarithm. Packs: to 1 ulp (2e-16) for 2^-12 <= value <= 2^12; beyond, that of the
  /// nearer end.
  [[gnu::always_inline]] static Pack log(const Pack& value) {
    if constexpr (std::is_floating_point_v<Pack>) {
      return std::log(value);
    } else {
      return log_of_pack(value);
    }
  }
  [[gnu::always_inline]] static Pack log_of_pack(const Pack& value) {
    constexpr double root = 1.4142135623730951;
    constexpr double ln2_high = 0x1.62e42fefa38p-1, ln2_low = 0x1.ef35793c7673p-45;
    // In cells near rest there is nothing to reduce.
    if (all_of(value >= Pack(0.5 * root) && value <= Pack(root))) {
      const Pack f = value - Pack(1.0);
      return f - correction(f);
    }
    const Pack power = 4096.0;
    Pack m = min(max(value, Pack(1.0) / power), power), exponent = 0.0;
    constexpr double steps[4] = {8.0, 4.0, 2.0, 1.0}, factors[4] = {256.0, 16.0, 4.0, 2.0};
    for (int s = 0; s < 4; ++s) {
      const auto large = m > Pack(0.5 * root * factors[s]);
      where(large, m) = m * Pack(1.0 / factors[s]);
      where(large, exponent) = exponent + Pack(steps[s]);
      const auto small = m < Pack(root / factors[s]);
      where(small, m) = m * Pack(factors[s]);
      where(small, exponent) = exponent - Pack(steps[s]);
    }
    const Pack f = m - Pack(1.0);
    return exponent * Pack(ln2_high) + (f - (correction(f) - exponent * Pack(ln2_low)));
  }

  /// f - ln(1 + f) for 1/√2 <= 1 + f <= √2: with s = f/(2 + f), ln(1 + f) = 2 artanh s =
  /// f - s (f - R), R = s² (2/3 + 2/5 s² + 2/7 s⁴ + ...); what is left out is below 3e-17 ln(1 +
  /// f).
  [[gnu::always_inline]] static Pack correction(const Pack& f) {
    const Pack s = f / (Pack(2.0) + f), z = s * s, z2 = z * z, z4 = z2 * z2;
    // Pairs of terms first (Estrin): everything waits for this sum.
    const auto pair = [&](int n) { return Pack(2.0 / n) + Pack(2.0 / (n + 2)) * z; };
    const Pack low = pair(3) + pair(7) * z2, middle = pair(11) + pair(15) * z2, high = pair(19);
    return s * (f - z * (low + z4 * (middle + z4 * high)));
  }
};

}  // namespace fingertip::lattice::inline kernels::kernel
