/// Packs of doubles, the one way in which the lattice is vectorised: `Pack` is a
/// std::experimental::simd as wide as the registers that the including file is compiled for, so its
/// type differs between compilations, which keeps their instantiations apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline kernels::kernel {

/// A pack as a vector of the compiler's own. (Of conversions ARM's lack one in libstdc++ 12.)
template <typename Pack>
[[gnu::always_inline]] inline auto raw_vector(const Pack& value) {
  using Raw [[gnu::vector_size(sizeof(Pack))]] = double;
  return __builtin_bit_cast(Raw, value);
}

/// Of packs, or of plain numbers. Inlined by force: handing dozens of packs on would lead through
/// memory.
template <typename Pack>
struct PackVector {
  Pack x, y, z;

  [[gnu::always_inline]] PackVector& operator+=(const PackVector& other) {
    return *this = *this + other;
  }
  [[gnu::always_inline]] friend PackVector operator+(const PackVector& a, const PackVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[gnu::always_inline]] friend PackVector operator-(const PackVector& a, const PackVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[gnu::always_inline]] friend PackVector operator*(const Pack& factor, const PackVector& a) {
    return {factor * a.x, factor * a.y, factor * a.z};
  }
  [[gnu::always_inline]] friend Pack dot(const PackVector& a, const PackVector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  [[gnu::always_inline]] friend PackVector cross(const PackVector& a, const PackVector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

/// Loads and stores of packs; `lanes` doubles are `parts` packs of `width`.
template <typename Pack>
struct Packs {
  using Vector = PackVector<Pack>;
  static constexpr std::size_t width = Pack::size();
  static constexpr std::size_t parts = lanes / width;

  [[gnu::always_inline]] static Pack load(const double* from) {
    return Pack(from, std::experimental::element_aligned);
  }
  [[gnu::always_inline]] static void store(double* to, const Pack& value) {
    value.copy_to(to, std::experimental::element_aligned);
  }
  [[gnu::always_inline]] static Vector load(const double* const* field, std::size_t i) {
    return {load(field[0] + i), load(field[1] + i), load(field[2] + i)};
  }
  static void store(double* const* field, std::size_t i, const Vector& value) {
    store(field[0] + i, value.x);
    store(field[1] + i, value.y);
    store(field[2] + i, value.z);
  }
  /// Keeps the compiler from moving what makes `value` behind what follows: it would put operations
  /// off and pass their operands through memory.
  [[gnu::always_inline]] static void keep([[maybe_unused]] Pack& value) {
#ifndef __wasm__  // which has no registers
    if constexpr (std::experimental::is_simd_v<Pack>) {
      auto raw = raw_vector(value);
#ifdef __x86_64__
      asm volatile("" : "+v"(raw));
#else
      asm volatile("" : "+w"(raw));
#endif
      value = Pack(raw);
    }
#endif
  }
  static Pack gather(const double* from, const std::uint32_t* index) {
    return Pack([&](auto lane) { return from[index[lane]]; });
  }
  static Vector gather(const double* const* field, const std::uint32_t* index) {
    return {gather(field[0], index), gather(field[1], index), gather(field[2], index)};
  }
  static void scatter(double* const* field, const std::uint32_t* index, const Vector& value) {
    for (std::size_t lane = 0; lane < width; ++lane) {
      field[0][index[lane]] = value.x[lane];
      field[1][index[lane]] = value.y[lane];
      field[2][index[lane]] = value.z[lane];
    }
  }
  /// Sum over all lanes in their order.
  static double total(const std::array<Pack, parts>& sum) {
    double result = 0.0;
    for (const Pack& part : sum) {
      for (std::size_t lane = 0; lane < width; ++lane) result += part[lane];
    }
    return result;
  }
  static void total(const std::array<Vector, parts>& sum, double* result) {
    std::array<Pack, parts> x, y, z;
    for (std::size_t part = 0; part < parts; ++part) {
      x[part] = sum[part].x;
      y[part] = sum[part].y;
      z[part] = sum[part].z;
    }
    result[0] = total(x);
    result[1] = total(y);
    result[2] = total(z);
  }
};

}  // namespace fingertip::lattice::inline kernels::kernel
